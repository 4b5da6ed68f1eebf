"""From the texts of functions to an object file, whose units others may call by their symbols."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from llvmlite import binding

SUPPORT = Path(__file__).with_name("support.ll")
SPEED = 3  # of LLVM's levels of optimisation


def object_of(texts: Iterable[str], names: Iterable[str], target: Any) -> bytes:
    """The object file with these functions, of which only those with names are seen."""
    module = binding.parse_assembly(SUPPORT.read_text(encoding="ascii"))
    for text in texts:
        module.link_in(binding.parse_assembly(text))
    seen = set(names)
    for function in module.functions:
        if function.is_declaration:
            continue
        if function.name in seen:
            # A table may change between two calls of a unit, and not in one: see `read_array`.
            function.add_function_attribute("noinline")
        else:
            function.linkage = "internal"
    tuning = binding.create_pipeline_tuning_options(speed_level=SPEED)
    tuning.loop_vectorization, tuning.slp_vectorization = False, True  # vectors of a few numbers
    builder = binding.create_pass_builder(target, tuning)
    builder.getModulePassManager().run(module, builder)
    module.verify()
    return bytes(target.emit_object(module))


def target_of(processor: str) -> Any:
    """What LLVM makes code for: a kind of processor of this machine's family."""
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    family = binding.Target.from_triple(binding.get_process_triple())
    return family.create_target_machine(cpu=processor, opt=SPEED, reloc="pic", codemodel="small")
