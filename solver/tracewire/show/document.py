"""A report as a document: headings, paragraphs, tables, code and figures, as Markdown or HTML."""

from __future__ import annotations

import base64
import html
import re
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from tracewire.errors import OptionError, Problem, unknown
from tracewire.show.summary import Table

STYLE = """body{font-family:sans-serif;max-width:56rem;margin:2rem auto;padding:0 1rem;color:#222;
line-height:1.45}
h2{margin-top:2.2rem;border-bottom:2px solid #e6e6e6;padding-bottom:.2rem}
figure{margin:1.2rem 0}figcaption{color:#555;font-size:.9rem}img{max-width:100%}
table{border-collapse:collapse;margin:1rem 0;display:block;overflow-x:auto}
td,th{border-bottom:1px solid #ddd;padding:.25rem .7rem;text-align:left;vertical-align:top}
caption{text-align:left;font-weight:bold;padding:.25rem 0}
table{font-size:.94rem}td.number{white-space:nowrap}
td.number,th.number{text-align:right;font-variant-numeric:tabular-nums}
li{margin:.25rem 0}
pre{background:#f5f5f5;padding:.8rem;overflow-x:auto}"""

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

    def write(self, path: str | Path) -> Path:
        """Write the report as .md, its figures beside it, or as .html, its figures inside it.

        An HTML report is one file that can be mailed; Markdown has no way to hold a picture.
        Returns the path of the report. Raises OptionError: another ending, a folder that does not
        exist or cannot be written.
        """
        path = Path(path)
        writers = {".md": self.markdown, ".html": self.html}
        if path.suffix not in writers:
            what = f"'{path}': {unknown('file ending', path.suffix, writers).what}"
            raise OptionError([Problem(what, hint="End it in .md or .html.")])
        try:
            path.touch()  # told before the figures are drawn
            path.write_text(writers[path.suffix](), encoding="utf-8")
            if path.suffix == ".md":
                for figure in self.figures:
                    figure.draw(path.parent / figure.name)
        except OSError as error:
            what = f"the report '{path}' cannot be written: {error.strerror or error}"
            raise OptionError([Problem(what, hint="Name a folder that exists.")]) from error
        return path

    @property
    def figures(self) -> tuple[Figure, ...]:
        """The figures of all sections."""
        return tuple(figure for section in self.sections for figure in section.figures)

    def markdown(self) -> str:
        """The document as Markdown; figures are named, and drawn by `write`."""
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
                lines += [f"![{_plain(figure.caption)}]({figure.name})", ""]
        return "\n".join(lines)

    def html(self) -> str:
        """The document as one HTML page, which holds its figures."""
        parts = [f"<h1>{html.escape(self.title)}</h1>"]
        for section in self.sections:
            parts.append(f"<h2>{html.escape(section.heading)}</h2>")
            parts += [f"<p>{_tagged(text)}</p>" for text in section.paragraphs]
            if section.points:
                points = "".join(f"<li>{_tagged(text)}</li>" for text in section.points)
                parts.append(f"<ul>{points}</ul>")
            parts += [_html_table(table) for table in section.tables]
            if section.code:
                parts.append(f"<pre>{html.escape(section.code)}</pre>")
            parts += [_html_figure(figure) for figure in section.figures]
        head = (
            f'<!doctype html><html lang="en"><head><meta charset="utf-8">'
            f'<meta name="viewport" content="width=device-width">'
            f"<title>{html.escape(self.title)}</title><style>{STYLE}</style></head>"
        )
        return head + "<body>" + "\n".join(parts) + "</body></html>\n"


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


def _html_table(table: Table) -> str:
    kinds = [' class="number"' if n in table.numeric else "" for n in range(len(table.header))]
    head = "".join(
        f"<th{kind}>{html.escape(cell)}</th>"
        for kind, cell in zip(kinds, table.header, strict=True)
    )
    rows = []
    for row in table.rows:
        cells = (
            f"<td{kind}>{html.escape(cell)}</td>" for kind, cell in zip(kinds, row, strict=True)
        )
        rows.append("<tr>" + "".join(cells) + "</tr>")
    caption = f"<caption>{html.escape(table.title)}</caption>" if table.title else ""
    return f"<table>{caption}<tr>{head}</tr>{''.join(rows)}</table>"


def _html_figure(figure: Figure) -> str:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / figure.name
        figure.draw(file)
        data = base64.b64encode(file.read_bytes()).decode("ascii")
    kind = {".svg": "image/svg+xml"}.get(file.suffix, "image/png")
    caption = html.escape(figure.caption)
    return (
        f'<figure><img src="data:{kind};base64,{data}" alt="{caption}">'
        f"<figcaption>{caption}</figcaption></figure>"
    )
