"""The index of the measured sets: where each comes from, to the bit, and what is made of it.

The files stay where their owners put them: each is fetched from its repository at one commit, and
its SHA-256 must be the one below. What no reader of tracewire takes as it is, is written once more
as a CSV beside it (`tracewire.data.made`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path, PurePosixPath

from tracewire.data.made import balls_dropped, bench_period, motor_turn, swing_large, swing_small

RAW = "https://raw.githubusercontent.com"


@dataclass(frozen=True)
class Upstream:
    """A file of a repository: its path there, the SHA-256 of its content, and the name that it gets
    on a user's disk where that is another than in the repository."""

    path: str
    sha256: str
    called: str = ""

    @property
    def name(self) -> str:
        """The name that it has on a user's disk."""
        return self.called or PurePosixPath(self.path).name


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
    "emps": DataSet(
        "An electro-mechanical positioning system under control",
        "forgi86/sysid-neural-continuous",
        "93afc131780fb1d5477472935a18ac8405683890",
        "none stated, a free benchmark: cite its authors",
        (
            Upstream(
                "examples/EMPS/data/DATA_EMPS.mat",
                "6cf6814ae14618795da0101aae2bb97ff0c6351b0501b5492751b02b07facf7e",
            ),
            Upstream(
                "examples/EMPS/data/DATA_EMPS_PULSES.mat",
                "0eab75bb1f6b16228ee78791343a88bf9bfd9a51036ac9807d7b5fc11c0e1704",
            ),
        ),
    ),
    "piezo_hysteresis": DataSet(
        "A piezoelectric actuator, from voltage to displacement",
        "yan9a/DiscreteBacklashOperator",
        "79fd060d86cdf69be2388e29bf57b0766c273650",
        "MIT",
        (
            Upstream(
                "MatLabCode/DiscreteBacklashModel/Model_Vi_Do.dat",
                "672714f09302b892721aa44d72f337a7ee1a0eb1d107f4d6797ab47d849428ae",
            ),
            Upstream(
                "MatLabCode/DiscreteBacklashModel/Test_Vi_Do_Di.dat",
                "6c33cb76d3f6e12f5074626710f71aeb43d8411a5ad0a56469ad01904221aae5",
            ),
        ),
    ),
    "motor_cogging": DataSet(
        "A brushless motor in slow turns",
        "gchenfc/ODrive",
        "54611550c141fb024b663d1d17fc98dc2c5b7fd3",
        "MIT",
        (
            Upstream(
                "analysis/cogging_torque/slow2/nocomp_0.npy",
                "34bfad8a188ebbff0be770a759b3eba6dbaec849910116e15a33171f04ec51c5",
                "slow2_nocomp_0.npy",
            ),
            Upstream(
                "analysis/cogging_torque/slow2/nocomp_1.npy",
                "43723619d6f3c6af30d362ae1f0a6881cccda2320c0ba782eaf43a2dc027f523",
                "slow2_nocomp_1.npy",
            ),
            Upstream(
                "analysis/cogging_torque/slow2_slower/nocomp_0.npy",
                "44eedcbdd4e04a82e984a25e08e0b679612300662ce19367a4c7cb2e26d2e418",
                "slow2_slower_nocomp_0.npy",
            ),
        ),
        {
            "turn_0.csv": partial(motor_turn, name="slow2_nocomp_0.npy"),
            "turn_1.csv": partial(motor_turn, name="slow2_nocomp_1.npy"),
            "slower.csv": partial(motor_turn, name="slow2_slower_nocomp_0.npy"),
        },
    ),
    "pneumatic_seal_friction": DataSet(
        "A 3D-printed pneumatic cylinder, slow strokes at four pressures",
        "EvaZillen/3D-printed-pneumatic-actuator",
        "6e0bcb4633bd53b2a8544cdbd497c4c06539afc7",
        "CC0 1.0",
        (
            Upstream(
                "results_pneumatic-actuator/data/friction/Circle_1bar.csv",
                "b795d01ad801c0a4222ca0bd4fa561dbbb7a3c87546b0e2cbdc13efc2c9c874b",
            ),
            Upstream(
                "results_pneumatic-actuator/data/friction/Circle_3bar.csv",
                "d78d5575b6d9dcf57453107bea96b6dd8d59944a9f2df57f448621025115dade",
            ),
            Upstream(
                "results_pneumatic-actuator/data/friction/Circle_5bar.csv",
                "163b266a3ae723b4d3d8be90ad50f3caca390fa5e76ff13a7c5287a1c8502755",
            ),
            Upstream(
                "results_pneumatic-actuator/data/friction/Circle_7bar.csv",
                "e3814abff4dae2bfa70a53d925a5990699dc65e5a6472b42d1dad01293de7a35",
            ),
        ),
    ),
    "twomass_bench": DataSet(
        "Two masses and a flexible coupling, shaken by a motor",
        "HoriFujimotoLab/FdiTools",
        "5925fae7e65f091b4111b1ba123e08dd869cb590",
        "MIT",
        (
            Upstream(
                "Examples/private/MultisineTypeA.mat",
                "a15dadc2e756ceddd927935f9c4c547cdcaef95c8611fc39087c848b3a8acb26",
            ),
        ),
        {
            "periods_4_12.csv": partial(bench_period, first=4, last=12),
            "periods_13_20.csv": partial(bench_period, first=13, last=20),
        },
    ),
}
