"""`animate`: a run as a moving picture of its mechanism, which the scene of the diagram says."""

from __future__ import annotations

import math
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tracewire.arguments import checked
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, unknown
from tracewire.files import replacing, write_file
from tracewire.show.limits import SCENE
from tracewire.show.scene import COLORS, add_part, extent_of, moved_parts, required_scene
from tracewire.show.style import cut, styled
from tracewire.solve import Run

if TYPE_CHECKING:
    from PIL.Image import Image

ENDINGS = (".gif", ".mp4")


@checked
def animate(
    run: Run,
    path: str | Path,
    *,
    speed: float = 1.0,
    fps: float = 25.0,
    width: int = 480,
    progress: Callable[[float], None] | None = None,
) -> Path:
    """Write a run as a moving picture to a .gif file, or to .mp4 where ffmpeg is installed.

    What is drawn is the `scene` of the diagram. `speed` is the time of the run per time of the
    film: 1 plays it as it is, 0.1 ten times slower. `fps` is the number of pictures in a second, in
    a GIF rounded to a whole number of 10 ms for each; `width` is in pixels. A picture shows the
    sample next to its time. `progress` is told the part that is done. The same run gives the same
    file. Raises OptionError: no scene, a signal of it that was not recorded, another ending, no
    ffmpeg, a number out of its range; OSError.
    """
    path = Path(path)
    span = float(run.t[0]), float(run.t[-1])
    times = frame_times(run.model, span, path, speed=speed, fps=fps, width=width)
    with styled():
        frames = _frames(run, times, width, progress or (lambda part: None))
        if path.suffix == ".gif":
            _write_gif(path, frames, _pause(path, fps))
        else:
            _write_mp4(path, frames, fps)
    return path


def frame_times(
    model: Model | None,
    span: tuple[float, float],
    path: str | Path,
    *,
    speed: float = 1.0,
    fps: float = 25.0,
    width: int = 480,
) -> NDArray[np.float64]:
    """The times (F,) in s at which a film of a span of a model has its pictures; see `animate`.

    Raises OptionError for what could not be filmed, before there is a run.
    """
    required_scene(model)
    path = Path(path)
    if path.suffix not in ENDINGS:
        raise OptionError([unknown("ending of a film", path.suffix, ENDINGS)])
    if path.suffix == ".mp4" and shutil.which("ffmpeg") is None:
        what = "an .mp4 file is made by the program ffmpeg, which is not installed"
        hint = "Install ffmpeg (on Debian: apt-get install ffmpeg), or write a .gif."
        raise OptionError([Problem(what, hint=hint)])
    if not (0 < speed < math.inf and 1 <= fps <= 100):
        what = f"a film with speed {speed:g} and {fps:g} pictures in a second cannot be made"
        raise OptionError([Problem(what, hint="Give a speed above 0, and fps from 1 to 100.")])
    if not SCENE.widths[0] <= width <= SCENE.widths[1]:
        what = f"a picture cannot be {width} pixels wide"
        hint = f"Give a width from {SCENE.widths[0]} to {SCENE.widths[1]}."
        raise OptionError([Problem(what, hint=hint)])
    begin, end = span
    if not begin < end:
        what = f"the span from {begin:g} to {end:g} s is empty"
        raise OptionError([Problem(what, hint="Give a begin before the end.")])
    step = _pause(path, fps) * speed
    count = math.floor((end - begin) / step * (1 + 1e-12)) + 1
    if count > SCENE.most_frames:
        what = f"a film of {end - begin:g} s with speed {speed:g} has {count} pictures"
        hint = f"At most {SCENE.most_frames} are made: "
        hint += "give a shorter span, a higher speed, or fewer fps."
        raise OptionError([Problem(what, hint=hint)])
    return np.asarray(np.minimum(begin + step * np.arange(count), end))


def _pause(path: Path, fps: float) -> float:
    """The time in s from one picture to the next."""
    return max(round(1 / fps / SCENE.tick), 1) * SCENE.tick if path.suffix == ".gif" else 1 / fps


def _frames(
    run: Run, times: NDArray[np.float64], width: int, tell: Callable[[float], None]
) -> Iterator[Image]:
    """The pictures of a film. What moves is drawn anew over what does not."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from PIL import Image

    parts = moved_parts(run)
    left, right, bottom, top = extent_of(parts)
    middle, tall = (bottom + top) / 2, (top - bottom) / (right - left)
    tall = min(max(tall, SCENE.least_height), SCENE.most_height)
    inches = width / SCENE.dots
    height = inches * tall + SCENE.head
    # ffmpeg wants even numbers of pixels
    size = (2 * (width // 2) / SCENE.dots, 2 * round(height * SCENE.dots / 2) / SCENE.dots)
    figure = Figure(figsize=size, dpi=SCENE.dots)
    canvas: Any = FigureCanvasAgg(figure)  # its methods have no types
    panel = figure.add_axes((0, 0, 1, 1 - SCENE.head / height))
    panel.set_axis_off()
    across = max(right - left, (top - bottom) / tall)
    panel.set_xlim((left + right - across) / 2, (left + right + across) / 2)
    panel.set_ylim(middle - across * tall / 2, middle + across * tall / 2)
    title = cut(run.title, max(int((width - 110) / SCENE.letter), 3))
    figure.text(0.02, 0.985, title, va="top", fontsize=10)
    clock = figure.text(0.98, 0.985, "", va="top", ha="right", fontsize=10, color="#555555")
    clock.set_fontfamily("monospace")
    added = [add_part(panel, part, run.t, right - left) for part in parts]
    artists = [clock, *(artist for own, _ in added for artist in own)]
    artists.sort(key=lambda artist: artist.zorder)
    for artist in artists:
        artist.set_animated(True)
    canvas.draw()
    still = canvas.copy_from_bbox(figure.bbox)
    digits = max(0, 2 - math.floor(math.log10(max(times[-1] - times[0], 1e-9))))
    nearest = _nearest(run.t, times)
    for number, (k, time) in enumerate(zip(nearest.tolist(), times.tolist(), strict=True)):
        canvas.restore_region(still)
        clock.set_text(f"t = {time:.{min(digits, 4)}f} s")
        for _, update in added:
            update(k)
        for artist in artists:
            figure.draw_artist(artist)
        tell((number + 1) / len(times))
        yield Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")


def _nearest(t: NDArray[np.float64], times: NDArray[np.float64]) -> NDArray[np.intp]:
    """The numbers of the samples next to the times."""
    after = np.searchsorted(t, times).clip(1, len(t) - 1)
    return np.where(times - t[after - 1] <= t[after] - times, after - 1, after)


def _write_gif(path: Path, frames: Iterator[Image], pause: float) -> None:
    """Write pictures that all have the same colours, so that none flickers.

    Each one is written at once, as what has changed since the one before it: a film of a minute
    would else need a gigabyte of memory.
    """
    from PIL import GifImagePlugin, Image, ImageChops

    palette = Image.new("P", (1, 1))
    palette.putpalette(_palette())
    pictures = (frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    before = waiting = next(pictures)
    place, duration = (0, 0), 0.0
    with replacing(path) as file:
        header, _ = GifImagePlugin.getheader(before, info={"loop": 0, "duration": 1000 * pause})
        file.writelines(header)
        for picture in pictures:
            duration += pause
            changed = ImageChops.difference(before, picture).getbbox()
            if changed is None:  # the one before stays for longer
                continue
            file.writelines(GifImagePlugin.getdata(waiting, place, duration=_ms(duration)))
            before, waiting, place = picture, picture.crop(changed), changed[:2]
            duration = 0.0
        file.writelines(GifImagePlugin.getdata(waiting, place, duration=_ms(duration + pause)))
        file.write(b";")


def _ms(seconds: float) -> int:
    return round(1000 * seconds)


def _palette() -> list[int]:
    """The colours of parts with their shades up to white: red, green, blue, red, ..."""
    colors = np.array([[int(text[n : n + 2], 16) for n in (1, 3, 5)] for text in COLORS.values()])
    white = np.linspace(0.0, 1.0, SCENE.shades)[:, None, None]
    shades = colors * (1 - white) + 255.0 * white
    found: list[int] = np.rint(shades).astype(int).ravel().tolist()
    return found


def _write_mp4(path: Path, frames: Iterator[Image], fps: float) -> None:
    """Hand pictures to ffmpeg, which needs a file that it can go back in."""
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / "film.mp4"
        first = next(frames)
        command = [
            *("ffmpeg", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"),
            *("-s", f"{first.width}x{first.height}", "-r", f"{fps:g}", "-i", "-", "-an"),
            *("-pix_fmt", "yuv420p", "-fflags", "+bitexact", "-flags:v", "+bitexact"),
            *("-movflags", "+faststart", str(made)),
        ]
        with tempfile.TemporaryFile() as errors:
            with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=errors) as ffmpeg:
                assert ffmpeg.stdin is not None
                try:
                    ffmpeg.stdin.write(first.tobytes())
                    for frame in frames:
                        ffmpeg.stdin.write(frame.tobytes())
                    ffmpeg.stdin.close()
                except BrokenPipeError:  # it has ended, and says why below
                    pass
            errors.seek(0)
            said = errors.read().decode(errors="replace").strip()
        if ffmpeg.returncode or not made.is_file():
            what = f"ffmpeg could not make '{path}': {' '.join(said.split())[-200:]}"
            raise OptionError([Problem(what, hint="Write a .gif, or install another ffmpeg.")])
        write_file(path, made.read_bytes())
