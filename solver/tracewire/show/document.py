"""A report as a document: headings, paragraphs, tables, code and figures, as Markdown or HTML."""

from __future__ import annotations

import html
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from tracewire.errors import OptionError, Problem, unknown
from tracewire.show.summary import Table

STYLE = """body{font-family:sans-serif;max-width:52rem;margin:2rem auto;padding:0 1rem;color:#222}
img{max-width:100%}table{border-collapse:collapse;margin:1rem 0}
td,th{border-bottom:1px solid #ddd;padding:.25rem .7rem;text-align:left}
caption{text-align:left;font-weight:bold;padding:.25rem 0}
td.number{text-align:right;font-variant-numeric:tabular-nums}
pre{background:#f5f5f5;padding:.8rem;overflow-x:auto}"""


@dataclass(frozen=True)
class Figure:
    """A figure of a report: the name of its file, its caption, and the function that draws it."""

    name: str
    caption: str
    draw: Callable[[Path], object]


@dataclass(frozen=True)
class Section:
    """A heading and what stands under it: paragraphs, tables, code, figures, in this order."""

    heading: str
    paragraphs: tuple[str, ...] = ()
    tables: tuple[Table, ...] = ()
    code: str = ""
    figures: tuple[Figure, ...] = field(default_factory=tuple)


@dataclass(frozen=True)
class Report:
    """A document about a run, a fit or a trace."""

    title: str
    sections: tuple[Section, ...]

    def write(self, path: str | Path) -> Path:
        """Write the report as .md or .html, its figures beside it; the path of the report.

        Raises OptionError: another ending, a folder that does not exist or cannot be written.
        """
        path = Path(path)
        writers = {".md": self.markdown, ".html": self.html}
        if path.suffix not in writers:
            what = f"'{path}': {unknown('file ending', path.suffix, writers).what}"
            raise OptionError([Problem(what, hint="End it in .md or .html.")])
        try:
            path.write_text(writers[path.suffix](), encoding="utf-8")
            for section in self.sections:
                for figure in section.figures:
                    figure.draw(path.parent / figure.name)
        except OSError as error:
            what = f"the report '{path}' cannot be written: {error.strerror or error}"
            raise OptionError([Problem(what, hint="Name a folder that exists.")]) from error
        return path

    def markdown(self) -> str:
        """The document as Markdown."""
        lines = [f"# {self.title}", ""]
        for section in self.sections:
            lines += [f"## {section.heading}", ""]
            for paragraph in section.paragraphs:
                lines += [paragraph, ""]
            for table in section.tables:
                if table.title:
                    lines += [f"**{table.title}**", ""]
                lines += [*_markdown_table(table), ""]
            if section.code:
                lines += ["```", section.code.rstrip("\n"), "```", ""]
            for figure in section.figures:
                lines += [f"![{figure.caption}]({figure.name})", ""]
        return "\n".join(lines)

    def html(self) -> str:
        """The document as one HTML page; figures are files beside it."""
        parts = [f"<h1>{html.escape(self.title)}</h1>"]
        for section in self.sections:
            parts.append(f"<h2>{html.escape(section.heading)}</h2>")
            parts += [f"<p>{html.escape(text)}</p>" for text in section.paragraphs]
            parts += [_html_table(table) for table in section.tables]
            if section.code:
                parts.append(f"<pre>{html.escape(section.code)}</pre>")
            for figure in section.figures:
                name, caption = html.escape(figure.name), html.escape(figure.caption)
                parts.append(
                    f'<figure><img src="{name}" alt="{caption}">'
                    f"<figcaption>{caption}</figcaption></figure>"
                )
        head = (
            f'<!doctype html><html lang="en"><head><meta charset="utf-8">'
            f"<title>{html.escape(self.title)}</title><style>{STYLE}</style></head>"
        )
        return head + "<body>" + "\n".join(parts) + "</body></html>\n"


def _markdown_table(table: Table) -> list[str]:
    rules = ["---:" if n in table.numeric else "---" for n in range(len(table.header))]
    rows = [table.header, tuple(rules), *table.rows]
    return ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in rows]


def _html_table(table: Table) -> str:
    head = "".join(f"<th>{html.escape(cell)}</th>" for cell in table.header)
    rows = []
    for row in table.rows:
        cells = (
            f'<td class="number">{html.escape(cell)}</td>'
            if n in table.numeric
            else f"<td>{html.escape(cell)}</td>"
            for n, cell in enumerate(row)
        )
        rows.append("<tr>" + "".join(cells) + "</tr>")
    caption = f"<caption>{html.escape(table.title)}</caption>" if table.title else ""
    return f"<table>{caption}<tr>{head}</tr>{''.join(rows)}</table>"
