"""Sets of real measurements: where each comes from, to the bit, and how a user gets it.

The files stay where their owners put them: each is fetched from its repository at one commit, and
its SHA-256 must be the one below. What no reader of tracewire takes as it is, is written once more
as a CSV beside it (`tracewire.data.made`).
"""

from __future__ import annotations

import hashlib
import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from tracewire.data.made import balls_dropped, swing_large, swing_small
from tracewire.errors import DownloadError, OptionError, Place, Problem, unknown
from tracewire.shipped import shipped

RAW = "https://raw.githubusercontent.com"
DIAGRAMS = (".yaml", ".md")
Tell = Callable[[str], None]


@dataclass(frozen=True)
class Upstream:
    """A file of a repository: its path there, and the SHA-256 of its content."""

    path: str
    sha256: str

    @property
    def name(self) -> str:
        """The name that it has on a user's disk."""
        return PurePosixPath(self.path).name


@dataclass(frozen=True)
class DataSet:
    """A set of measurements: its files at one commit of a repository, and what is made of them.

    made: name of a CSV -> what gives its text from the folder with the files.
    """

    title: str
    repository: str
    commit: str
    licence: str
    files: tuple[Upstream, ...]
    made: Mapping[str, Callable[[Path], str]] = field(default_factory=dict)

    def address(self, file: Upstream, base: str = RAW) -> str:
        """Where a file is fetched from."""
        return f"{base}/{self.repository}/{self.commit}/{file.path}"


SETS: Mapping[str, DataSet] = {
    "multiarm_pendulum": DataSet(
        "One arm of a pendulum on a locked cart, large and small free swing",
        "dynamicslab/MultiArm-Pendulum",
        "e99a7e13fe2adc8fc647321a156b6cb59a48a698",
        "MIT, (c) 2022 dynamicslab",
        (
            Upstream(
                "ParameterEstimation/SinglePendulum/SinglePendulumDataForParameterEstimation.mat",
                "f3b8cdda4a6e86405ec37ff32b98be76fd37806a609cba7870628c1e40377a98",
            ),
            Upstream(
                "Datas/SinglePendulum/SingleDataFreeSwing_1_Dt_0_0001.mat",
                "5e6272350a91fb9fb99b6949bc49e3e63e21af977cc1f777310f5d8e9b0fc7e7",
            ),
        ),
        {"swing_large.csv": swing_large, "swing_small.csv": swing_small},
    ),
    "mr_damper": DataSet(
        "A magneto-rheological damper on a shaking table",
        "labcontrol-data/mr-damper",
        "e42439f08b227bb08e9923ee2736bedf2f4fe59a",
        "MIT",
        (
            Upstream(
                "data/data_simulation_4.1_MRdamper.mat",
                "97d7735351c9907159aa3c7038712ec1371685f608eb61d6a793622dad486866",
            ),
            Upstream(
                "data/data_simulation_4.2_MRdamper.mat",
                "a607d78cd52a2e7ae0b1059bb08345def8ee0e1913645071d23d74686acc9046",
            ),
            Upstream(
                "data/data_simulation_4.4_MRdamper.mat",
                "fd4be6ad437614c8e68ed459f1f4172d28c4f448444b5df579ed3aaaf8f8fd90",
            ),
        ),
    ),
    "bicycle_wheel_pendulum": DataSet(
        "A bicycle wheel that swings and twists, seen by a rate gyro",
        "moorepants/resonance",
        "f7f8550830e6a7e35f595acbbfaffad86174abd8",
        "MIT",
        (
            Upstream(
                "notebooks/03/bicycle-wheel-axial-inertia-rate-gyro-measurement.csv",
                "b39bba20f420f4083010c44057a235e9ed66ca8542adf4d3158aacccefa70092",
            ),
            Upstream(
                "notebooks/03/bicycle-wheel-radial-inertia-rate-gyro-measurement.csv",
                "83981cc5a86907c4e3a0cd3ee75cdb5aeab32b506150ca757d472db79e5e6933",
            ),
        ),
    ),
    "tribometer_presliding": DataSet(
        "Friction loops of a tribometer, with the way before it slips",
        "jchristopherson/FrictionModels.jl",
        "e60a4bd245dfc96aeb7045998a535f9bcb24cb0c",
        "MIT",
        (
            Upstream(
                "examples/test_data_2.txt",
                "e0abf58da8288eebe180a8fe191f1f223a5e1c43025e37c3db7cfb03ce9488a5",
            ),
        ),
    ),
    "falling_balls": DataSet(
        "Eleven balls dropped from a bridge, twice each",
        "briandesilva/discovery-of-physics-from-data",
        "b79c34317f049c9b47aaf2cc4c54c5ec7219f3d7",
        "MIT",
        (
            Upstream(
                "data/Ball_drops_data.xls",
                "942b2d68abfff3828ca323de491435d4ec27c3a22e62cee0cbdf52c2e8d1c0ed",
            ),
        ),
        {"drops.csv": balls_dropped},
    ),
}


def data_set(name: str) -> DataSet:
    """The set of a name. Raises OptionError."""
    if name not in SETS:
        raise OptionError([unknown("set of measurements", name, SETS)])
    return SETS[name]


def get_set(
    name: str, to: str | Path = ".", tell: Tell = lambda text: None, base: str = RAW
) -> Path:
    """Bring a set: the folder `to`/`name` with its diagrams, and its files in `data/` below.

    A file that is there and has the right content is not fetched again; a diagram that is there is
    kept. tell: called with a line for each file. Raises OptionError where there is no such set, or
    no folder `to`; DownloadError where pooch is missing, the network, or the file is another.
    """
    chosen = data_set(name)
    if not Path(to).is_dir():
        hint = "Make the folder first, or name another."
        raise OptionError([Problem(f"there is no folder '{to}'", hint=hint)])
    home = Path(to) / name
    try:
        (home / "data").mkdir(parents=True, exist_ok=True)
        for file in chosen.files:
            fetch(chosen, file, home / "data", tell, base)
        for made, text_of in chosen.made.items():
            (home / "data" / made).write_text(text_of(home / "data"), encoding="utf-8")
            tell(f"made     {home / 'data' / made}")
        for source in sorted((shipped("diagrams") / "real" / name).glob("*")):
            if source.suffix in DIAGRAMS and not (home / source.name).exists():
                (home / source.name).write_bytes(source.read_bytes())
                tell(f"copied   {home / source.name}")
    except OSError as error:
        hint = "Check its name and rights, and the space on the disk."
        what = f"'{error.filename or home}' cannot be written: {error.strerror or error}"
        raise DownloadError([Problem(what, hint=hint)]) from error
    return home


def fetch(
    chosen: DataSet, file: Upstream, folder: Path, tell: Tell = lambda text: None, base: str = RAW
) -> None:
    """Fetch a file of a set into a folder, unless it is there. Raises DownloadError."""
    path = folder / file.name
    if path.is_file() and hashlib.sha256(path.read_bytes()).hexdigest() == file.sha256:
        tell(f"is there {path}")
        return
    address = chosen.address(file, base)
    tell(f"fetching {address}")
    try:
        pooch = importlib.import_module("pooch")
    except ImportError as error:
        what = "the package pooch is needed to fetch files"
        hint = f"Install tracewire with it: pip install 'tracewire[data]'. {_by_hand(path)}"
        raise DownloadError([Problem(what, exists=(), hint=hint)]) from error
    pooch.get_logger().setLevel("ERROR")  # what is fetched has been told
    try:
        pooch.retrieve(address, f"sha256:{file.sha256}", fname=file.name, path=folder)
    except ValueError as error:
        what = f"what came from {address} is not the file of this set: its SHA-256 is another"
        hint = f"It must be {file.sha256}. Nothing was kept."
        raise DownloadError([Problem(what, Place(str(path)), hint=hint)]) from error
    except Exception as error:  # of the library under pooch, whose errors have no common class
        if isinstance(error, OSError) and error.filename:
            raise
        what = f"{address} could not be fetched ({type(error).__name__})"
        hint = f"Check the network, and try again. {_by_hand(path)}"
        raise DownloadError([Problem(what, hint=hint)]) from error


def _by_hand(path: Path) -> str:
    return f"Or put the file to '{path}' yourself."
