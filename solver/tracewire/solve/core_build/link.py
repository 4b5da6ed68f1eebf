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
    module, seen = _linked([SUPPORT.read_text(encoding="ascii"), *texts]), set(names)
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


def _linked(texts: Iterable[str]) -> Any:
    """One module of all texts. They are linked in pairs, and these in pairs again: to link one in
    takes the longer, the more there is already."""
    modules = [binding.parse_assembly(text) for text in texts]
    while len(modules) > 1:
        for one, other in zip(modules[::2], modules[1::2], strict=False):
            one.link_in(other)
        modules = modules[::2]
    return modules[0]


def target_of(processor: str) -> Any:
    """What LLVM makes code for: a kind of processor of this machine's family."""
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    family = binding.Target.from_triple(binding.get_process_triple())
    return family.create_target_machine(cpu=processor, opt=SPEED, reloc="pic", codemodel="small")
