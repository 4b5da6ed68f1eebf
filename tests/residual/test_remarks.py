"""What is odd about a measured series beside its model is said in words."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from residual.series_files import FREE, PLAIN, TOP, model_of, one, wave, written
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.errors import DataError, DiagramError
from tracewire.residual import load_measured


def test_a_record_in_order_has_no_remarks(file: Path) -> None:
    wave(file)
    assert one(file, FREE).remarks == ()


def test_a_record_that_begins_elsewhere_and_names_no_start_is_remarked(file: Path) -> None:
    """A trace looked for what makes up for a start, and named an offset and a constant force."""
    wave(file)
    (remark,) = one(file, "time: t").remarks
    assert remark.startswith("theta begins at 0.5236, and the run is at 0 there (SI): where that")
    shifted = "{column: angle, unit: deg, offset: {value: 30, fit: [0, 60]}}"
    assert one(file, "time: t", shifted).remarks == ()


def noisy(file: Path, header: str) -> None:
    """A file with a swing in degrees whose sensor has a noise of 0.2 degrees."""
    t = np.arange(1000) * 0.01
    angle = 30 * np.cos(2 * np.pi * t) + np.random.default_rng(3).normal(0, 0.2, len(t))
    written(file, "\n".join([header, *(f"{x:.6g},{y:.6f}" for x, y in zip(t, angle, strict=True))]))


def test_a_noise_far_below_the_scatter_of_the_samples_is_remarked(file: Path) -> None:
    """The header alone says that the column is in degrees: the 0.0035 rad were meant in rad."""
    noisy(file, "t,angle [deg]")
    (remark,) = one(file, FREE, "{column: angle, sigma: 0.0035}").remarks
    start, _, rest = remark.partition("deg, and its samples scatter by ")
    assert start == "theta is declared with a noise of sigma = 0.0035 "
    assert float(rest.split()[0]) == pytest.approx(0.2, rel=0.2)
    assert remark.endswith(
        "sigma is in the unit of the column; correct it, or leave it out to have it estimated"
    )
    assert one(file, FREE, "{column: angle, sigma: 0.1}").remarks == ()


def test_a_noise_above_the_whole_signal_is_remarked(file: Path) -> None:
    noisy(file, "t,angle [deg]")
    (remark,) = one(file, FREE, "{column: angle, sigma: 60}").remarks
    assert "and the whole signal varies by 21.2 deg (rms): sigma is in the unit" in remark
    assert one(file, FREE, "{column: angle, sigma: 10}").remarks == ()


def test_degrees_that_were_taken_for_radians_are_remarked(file: Path) -> None:
    wave(file)
    assert one(file, "time: t", "angle").remarks == (
        "theta goes from -30 to 30 rad: is the column in degrees? Then say unit: deg",
    )
    assert one(file, "time: t", "{column: angle, gain: 160}").remarks == (), "a column of counts"


def test_milliseconds_that_were_taken_for_seconds_are_remarked(file: Path) -> None:
    wave(file, step=10.1)
    (remark,) = one(file, "time: t").remarks
    assert remark == (
        "the record is 4029.9 s long, and the diagram's span 6 s: is the time in ms? "
        "Then say time: {column: ..., unit: ms}"
    )


def test_a_record_beside_a_diagram_that_says_no_span_is_remarked(file: Path) -> None:
    t = wave(file, step=4.1)
    file.write_text((TOP + PLAIN).replace("span: [0, 6]\n", ""), encoding="utf-8")
    (run,) = load_measured(compile(read(file)))
    assert run.remarks == (
        "the diagram says no span, so that a run takes 0 to 1 s, and the record is from 0 to "
        f"{t[-1]:g} s: write span: [0, {t[-1]:g}]",
    )


def test_a_first_sample_far_from_the_begin_is_remarked(file: Path) -> None:
    written(file, "t,angle\n" + "".join(f"{1700000000 + i / 8},{math.sin(i)}\n" for i in range(99)))
    (remark,) = one(file, "time: t").remarks
    assert remark.startswith("the first sample is at t = 1.7e+09 s, far from the begin of the diag")
    assert one(file, "time: {column: t, zero: 1700000000}").remarks == ()


def test_an_angle_from_another_line_is_remarked(file: Path) -> None:
    t = wave(file)
    rows = (f"{x:.6g},{math.pi + 0.1 * math.cos(6 * x):.6f}" for x in t)
    written(file, "\n".join(["t,angle", *rows]))
    (remark,) = one(file, "time: t", "angle").remarks
    assert remark.startswith(
        "theta begins at 3.242 rad, about pi from the diagram's start at 0 rad"
    )


def test_remarks_are_on_the_window_that_is_used(file: Path) -> None:
    t = np.concatenate([np.arange(200), np.arange(300, 500)]) * 0.01
    written(file, "\n".join(["t,angle", *(f"{x:.6g},{math.cos(6 * x):.6f}" for x in t)]))
    assert one(file, FREE).remarks == (
        "a gap in the time, where the step is 0.01 s: 1.01 s after t = 1.99 s",
    )
    assert one(file, f"{FREE}, to: 1.9").remarks == ()


def test_an_input_that_rests_under_a_sign_is_remarked(file: Path) -> None:
    rows = "".join(f"{i / 100:g},0,{max(i - 20, 0) / 100:g}\n" for i in range(100))
    written(file, "t,angle,u\n" + rows)
    text = TOP.replace("of: drive", "of: rub").replace(
        "presets:", "  rub: {type: expression, formula: -sign(drive)}\npresets:"
    )
    series = PLAIN.replace("}}}", "}}, inputs: {drive: u}}")
    file.write_text(text + series, encoding="utf-8")
    (run,) = load_measured(compile(read(file)))
    (remark,) = [remark for remark in run.remarks if "input" in remark]
    assert remark.startswith("the input drive is exactly zero from 0 to 0.2 s: there 'rub' keeps")


def turning(file: Path, wrapped: bool = True) -> None:
    """A file with an angle that turns three times in 6 s, from -180 to 180 degrees."""
    t = np.arange(600) * 0.01
    angle = 180 * t + 0.05 * np.random.default_rng(4).normal(size=len(t))
    angle = (angle + 180) % 360 - 180 if wrapped else angle
    written(
        file, "\n".join(["t,angle", *(f"{x:.6g},{y:.4f}" for x, y in zip(t, angle, strict=True))])
    )


def test_an_angle_that_comes_round_is_remarked_where_nothing_says_so(file: Path) -> None:
    turning(file)
    (remark,) = one(file, FREE).remarks
    assert remark == (
        "theta jumps by about 360 deg 3 times, first at t = 1.01 s: does the angle come round? "
        "Then say modulo: 360"
    )
    assert one(file, FREE, "{column: angle, unit: deg, modulo: 360}").remarks == ()
    turning(file, wrapped=False)
    assert one(file, FREE).remarks == ()


def test_a_turn_in_radians_of_a_column_in_degrees_is_remarked(file: Path) -> None:
    turning(file)
    wrong = ("theta has modulo: 6.28 in deg: a turn is modulo: 360",)
    assert one(file, FREE, "{column: angle, unit: deg, modulo: 6.28}").remarks == wrong
    text = (file.parent / "run.csv").read_text(encoding="utf-8")
    written(file, text.replace("angle", "angle [deg]"))
    assert one(file, FREE, "{column: angle, modulo: 6.28}").remarks == wrong
    assert one(file, FREE, "{column: angle, modulo: 360}").remarks == ()


@pytest.mark.parametrize(
    ("header", "theta", "said"),
    [
        ("t,theta_deg,u", "theta_deg", "theta: the column 'theta_deg' is read in rad; where its"),
        ("t,theta_deg,u", "{column: theta_deg, unit: deg}", ""),
        ("t,theta_deg [rad],u", "theta_deg", ""),
        ("t,theta_rad,u", "theta_rad", ""),
        ("t,theta_V,u", "theta_V", ""),
    ],
)
def test_a_name_that_ends_with_another_unit_is_remarked(
    file: Path, header: str, theta: str, said: str
) -> None:
    wave(file, header)
    found = [remark for remark in one(file, FREE, theta).remarks if "is read in" in remark]
    assert len(found) == bool(said)
    assert "".join(found).startswith(said)


def test_a_time_whose_name_ends_with_another_unit_is_remarked(file: Path) -> None:
    wave(file, "t_ms,angle,u")
    free = FREE.replace("time: t,", "time: t_ms,")
    assert one(file, free).remarks == (
        "the time: the column 't_ms' is read in s; where its name tells its unit, say unit: ms",
    )
    assert one(file, free.replace("t_ms", "{column: t_ms, unit: s}")).remarks == ()


def coded(file: Path) -> None:
    """A file in which a logger wrote -9999 in twenty rows of 400, where it had no angle."""
    t = wave(file)
    rows = (file.parent / "run.csv").read_text(encoding="utf-8").splitlines()
    rows[101:121] = [f"{x:.6g},-9999,{x:.6g}" for x in t[100:120]]
    written(file, "\n".join(rows))


def test_numbers_that_stand_for_no_value_are_remarked_and_left_out_where_they_are_named(
    file: Path,
) -> None:
    coded(file)
    (remark,) = one(file, FREE).remarks
    assert remark == (
        "theta is exactly -9999 deg in 20 samples, far from all others, which are between -30 and "
        "30 deg: does the number stand for no value? Then say format: {missing: -9999}"
    )
    for missing in ("-9999", "[-1, -9999.0]"):
        run = one(file, f"{FREE}, format: {{missing: {missing}}}")
        assert len(run.t) == 380
        assert np.abs(run.values["theta"]).max() < 0.6


def test_an_input_has_a_value_in_each_row(file: Path) -> None:
    wave(file)
    with pytest.raises(DataError, match="is not finite in this row"):
        one(file, f"{FREE}, inputs: {{drive: u}}, format: {{missing: 1}}")


def test_what_stands_for_no_value_is_a_number(file: Path) -> None:
    with pytest.raises(DiagramError, match=r"'missing' of .* must be a number, not 'none'"):
        model_of(file, PLAIN.replace("time: t,", "time: t, format: {missing: none},"))
