// The text of the diagram: a plain text area with numbers of lines, and the mistakes below it.

import {Completion} from "./completion.js";
import {make, part} from "./page.js";

export class Editor {
  // key: the key of the last version of the text that has a diagram
  constructor(changed, key) {
    this.area = part("source");
    this.gutter = part("gutter");
    this.problems = [];
    this.area.addEventListener("input", () => { this.number(); changed(); });
    this.area.addEventListener("scroll", () => { this.gutter.scrollTop = this.area.scrollTop; });
    this.completion = new Completion(this.area, key);
  }

  get text() { return this.area.value; }

  set text(text) {
    if (text === this.area.value) return;
    const [begin, end, top] = [this.area.selectionStart, this.area.selectionEnd, this.area.scrollTop];
    this.area.value = text;
    this.area.setSelectionRange(Math.min(begin, text.length), Math.min(end, text.length));
    this.area.scrollTop = top;
    this.number();
  }

  number() {
    const wrong = new Set(this.problems.map((problem) => problem.line));
    const count = this.area.value.split("\n").length;
    const lines = [];
    for (let n = 1; n <= count; n++) {
      lines.push(make("div", {textContent: n, className: wrong.has(n) ? "wrong" : ""}));
    }
    this.gutter.replaceChildren(...lines);
    this.gutter.scrollTop = this.area.scrollTop;
  }

  // file: the name of this text; a mistake in another file has no line here
  mark(problems, file) {
    this.problems = problems.map((one) => (one.file === file ? one : {...one, line: 0}));
    part("problems").replaceChildren(...this.problems.map((problem) => {
      const words = problem.text.replace(`${file}:`, "line ");
      if (!problem.line) return make("li", {textContent: problem.text});
      return make("li", {}, make("button", {type: "button", textContent: words,
        onclick: () => this.jump(problem.line, problem.column)}));
    }));
    this.area.setAttribute("aria-invalid", String(problems.length > 0));
    this.number();
  }

  // the name of a block, to the line that begins with it; `sensor of x` to that of the measured x
  find(block) {
    const sensor = block.startsWith("sensor of ");
    const name = block.split(/[. ]/).pop().split("[")[0];
    const lines = this.area.value.split("\n");
    const from = sensor ? lines.findIndex((text) => text.startsWith("measured:")) : 0;
    const written = new RegExp(sensor ? `\\b${name}\\b` : `^\\s*${name}:`);
    const line = lines.findIndex((text, n) => n >= from && written.test(text));
    if (line >= 0) this.jump(line + 1);
  }

  jump(line, column = 1) {
    if (!line) return;
    const before = this.area.value.split("\n").slice(0, line - 1);
    const start = before.reduce((sum, text) => sum + text.length + 1, 0) + Math.max(column - 1, 0);
    this.area.focus();
    this.area.setSelectionRange(start, start);
    const high = this.area.scrollHeight / Math.max(1, this.area.value.split("\n").length);
    this.area.scrollTop = Math.max(0, (line - 4) * high);
  }
}
