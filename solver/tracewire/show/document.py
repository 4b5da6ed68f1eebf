"""A report as a document: headings, paragraphs, tables, code and figures, as Markdown or HTML."""

from __future__ import annotations

import base64
import html
import re
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tracewire.errors import OptionError, Problem, TracewireError, unknown
from tracewire.files import check_writable, write_file, writing
from tracewire.show.style import saved_figures
from tracewire.show.table import Table
from tracewire.show.uplot import scripts, style
from tracewire.show.zoom import curves_of

STYLE = """body{font-family:sans-serif;max-width:56rem;margin:2rem auto;padding:0 1rem;color:#222;
line-height:1.45}
h2{margin-top:2.2rem;border-bottom:2px solid #e6e6e6;padding-bottom:.2rem}
figure{margin:1.2rem 0}figcaption{color:#555;font-size:.9rem}
img{max-width:100%}img.drawing{zoom:1.3}
table{border-collapse:collapse;margin:1rem 0;display:block;overflow-x:auto}
td,th{border-bottom:1px solid #ddd;padding:.25rem .7rem;text-align:left;vertical-align:top}
caption{text-align:left;font-weight:bold;padding:.25rem 0}
table{font-size:.94rem}td.number{white-space:nowrap}
td.number,th.number{text-align:right;font-variant-numeric:tabular-nums}
li{margin:.25rem 0}
pre{background:#f5f5f5;padding:.8rem;overflow-x:auto;white-space:pre-wrap;overflow-wrap:anywhere}
@media(max-width:56rem){table{font-size:.82rem}td,th{padding:.2rem .35rem}}"""

MARKS = re.compile(r"([\\`*]|<(?=[\w/!?])|(?<!\w)_|_(?!\w))")
"""What Markdown would take for emphasis, code or HTML."""
CODE = re.compile(r"`([^`]+)`")
"""What a person types, in both kinds of document."""


@dataclass(frozen=True)
class Figure:
    """A figure of a report: the name of its file, its caption, and the function that draws it."""

    name: str
    caption: str
    draw: Callable[[Path], object]


Drawn = Mapping[str, Path | str]
"""What became of each figure, by its name: the file, or a sentence that says why there is none."""


@dataclass(frozen=True)
class Section:
    """A heading and what stands under it: paragraphs, points, tables, code, figures, in this order.

    `points` become a list with a bullet each.
    """

    heading: str
    paragraphs: tuple[str, ...] = ()
    tables: tuple[Table, ...] = ()
    code: str = ""
    figures: tuple[Figure, ...] = field(default_factory=tuple)
    points: tuple[str, ...] = ()


@dataclass(frozen=True)
class Report:
    """A document about a run, a fit or a trace."""

    title: str
    sections: tuple[Section, ...]

    def write(self, path: str | Path, note: Callable[[str], None] | None = None) -> Path:
        """Write the report as .md, its figures beside it, or as .html, its figures inside it.

        An HTML report is one file that can be mailed. Its curves over time zoom where scripts run,
        and are pictures elsewhere. The names of the figures of `trace.md` begin
        with `trace`, so that reports in one folder keep their own. A figure that cannot be drawn
        becomes a line of the report with the reason, and `note` gets that line, too. An older
        report stays until the new one is complete.
        Returns the path of the report.
        Raises OptionError: another ending, a folder that does not exist or cannot be written.
        """
        path = Path(path)
        if path.suffix not in (".md", ".html"):
            what = f"'{path}': {unknown('file ending', path.suffix, ('.md', '.html')).what}"
            raise OptionError([Problem(what, hint="End it in .md or .html.")])
        with writing(path):
            check_writable(path)  # told before the figures are drawn
            with tempfile.TemporaryDirectory() as folder:
                drawn = _draw(self.figures, Path(folder), note or (lambda text: None))
                if path.suffix == ".html":
                    write_file(path, self.html(drawn))
                else:
                    for name, file in drawn.items():
                        if isinstance(file, Path):
                            content = file.read_bytes()
                            write_file(path.with_name(_beside(path.stem, name)), content)
                    write_file(path, self.markdown(drawn, path.stem))
        return path

    @property
    def figures(self) -> tuple[Figure, ...]:
        """The figures of all sections."""
        return tuple(figure for section in self.sections for figure in section.figures)

    def markdown(self, drawn: Drawn | None = None, stem: str = "") -> str:
        """The document as Markdown, which names its figures; `stem` begins their names.

        `drawn` has what became of each figure; None: all will be drawn.
        """
        lines = [f"# {_plain(self.title)}", ""]
        for section in self.sections:
            lines += [f"## {_plain(section.heading)}", ""]
            for paragraph in section.paragraphs:
                lines += [_plain(paragraph), ""]
            if section.points:
                lines += [*(f"- {_plain(point)}" for point in section.points), ""]
            for table in section.tables:
                if table.title:
                    lines += [f"**{_plain(table.title)}**", ""]
                lines += [*_markdown_table(table), ""]
            if section.code:
                lines += ["```", section.code.rstrip("\n"), "```", ""]
            for figure in section.figures:
                failed = (drawn or {}).get(figure.name)
                shown = f"![{_plain(figure.caption)}]({_beside(stem, figure.name)})"
                lines += [_plain(failed) if isinstance(failed, str) else shown, ""]
        return "\n".join(lines)

    def html(self, drawn: Drawn | None = None) -> str:
        """The document as one HTML page, which holds its figures.

        `drawn` has what became of each figure; None: they are drawn now.
        """
        if drawn is None:
            with tempfile.TemporaryDirectory() as folder:
                return self.html(_draw(self.figures, Path(folder), lambda text: None))
        parts = [f"<h1>{html.escape(self.title)}</h1>"]
        for section in self.sections:
            parts.append(f"<h2>{html.escape(section.heading)}</h2>")
            parts += [f"<p>{_tagged(text)}</p>" for text in section.paragraphs]
            if section.points:
                points = "".join(f"<li>{_tagged(text)}</li>" for text in section.points)
                parts.append(f"<ul>{points}</ul>")
            parts += [table.html() for table in section.tables]
            if section.code:
                parts.append(f"<pre>{html.escape(section.code)}</pre>")
            parts += [_html_figure(figure, drawn[figure.name]) for figure in section.figures]
        zooming = any(isinstance(d, Path) and _curves(d).is_file() for d in drawn.values())
        if zooming:
            parts.append(f"<script>{report_script()}</script>")
        look = report_style(zooming)
        head = (
            f'<!doctype html><html lang="en"><head><meta charset="utf-8">'
            f'<meta name="viewport" content="width=device-width">'
            f"<title>{html.escape(self.title)}</title><style>{look}</style></head>"
        )
        return head + "<body>" + "\n".join(parts) + "</body></html>\n"


def report_script() -> str:
    """The script of an HTML report with curves that zoom; there is no other in it."""
    return scripts()


def report_style(zooming: bool) -> str:
    """The style sheet of an HTML report, with curves that zoom or without."""
    return STYLE + (style() if zooming else "")


def _plain(text: str) -> str:
    """Text that Markdown shows as it is; `code` stays code."""
    parts = CODE.split(text)
    parts[::2] = [MARKS.sub(r"\\\1", part) for part in parts[::2]]
    parts[1::2] = [f"`{part}`" for part in parts[1::2]]
    return "".join(parts)


def _tagged(text: str) -> str:
    """Text that HTML shows as it is; `code` becomes code."""
    return CODE.sub(r"<code>\1</code>", html.escape(text))


def _markdown_table(table: Table) -> list[str]:
    rules = ["---:" if n in table.numeric else "---" for n in range(len(table.header))]
    lines = ["| " + " | ".join(rules) + " |"]
    for row in (table.header, *table.rows):
        lines.append("| " + " | ".join(_plain(cell).replace("|", "\\|") for cell in row) + " |")
    return [lines[1], lines[0], *lines[2:]]


def _html_figure(figure: Figure, drawn: Path | str) -> str:
    if isinstance(drawn, str):
        return f"<p>{_tagged(drawn)}</p>"
    data = base64.b64encode(drawn.read_bytes()).decode("ascii")
    kind = {".svg": "image/svg+xml"}.get(drawn.suffix, "image/png")
    caption = html.escape(figure.caption)
    opening, curves = "<figure>", ""
    named = ' class="drawing"' if drawn.suffix == ".svg" else ""  # its letters are small
    if _curves(drawn).is_file():
        opening = '<figure class="curves">'
        text = _curves(drawn).read_text(encoding="utf-8")
        curves = f'<script type="application/json" class="curves">{text}</script>'
    return (
        f'{opening}<img{named} src="data:{kind};base64,{data}" alt="{caption}">'
        f"<figcaption>{caption}</figcaption>{curves}</figure>"
    )


def _curves(drawn: Path) -> Path:
    """The file of the curves of a figure, beside its picture, where it has some that zoom."""
    return drawn.with_name(f"{drawn.name}.curves")


def _draw(figures: Sequence[Figure], folder: Path, note: Callable[[str], None]) -> Drawn:
    """Draw figures into a folder: the file of each, or in words why there is none.

    Whatever fails in a figure costs that figure only: the work behind a report may have taken
    hours.
    """
    drawn: dict[str, Path | str] = {}
    for figure in figures:
        file = folder / figure.name
        try:
            with saved_figures() as saved:
                figure.draw(file)
            drawn[figure.name] = file
            curves = curves_of(saved[-1]) if saved else None
            if curves is not None:
                write_file(_curves(file), curves)
        except Exception as error:
            reason = str(error) if isinstance(error, TracewireError) else repr(error)
            text = f"The figure '{figure.caption}' could not be drawn: {reason.rstrip('.')}."
            drawn[figure.name] = " ".join(text.split())
            note(str(drawn[figure.name]))
    return drawn


def _beside(stem: str, name: str) -> str:
    """The name of a figure beside the report of that stem."""
    own = not stem or Path(name).stem == stem or name.startswith(f"{stem}_")
    return name if own else f"{stem}_{name}"
