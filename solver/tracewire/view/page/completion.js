// What may be written at the cursor of the text: a list below it, from the keys and names of the diagram.

import {ask} from "./api.js";
import {make, part} from "./page.js";

const WAIT = 80;  // ms without a key before the list is asked for
const ASKS = /[A-Za-z_.]$|[{\[,:(] $|^ +$/;  // what the line ends with where the list opens by itself

export class Completion {
  // key: the key of the last version of the text that has a diagram
  constructor(area, key) {
    this.area = area;
    this.key = key;
    this.list = part("completion");
    this.proposals = [];
    this.chosen = 0;
    this.asked = 0;
    this.timer = 0;
    area.addEventListener("input", (event) => this.typed(event));
    area.addEventListener("keydown", (event) => this.press(event));
    area.addEventListener("blur", () => this.close());
    area.addEventListener("scroll", () => this.close());
    area.addEventListener("pointerdown", () => this.close());
    this.list.addEventListener("pointerdown", (event) => {
      event.preventDefault();  // the cursor stays in the text
      const row = event.target.closest("li");
      if (row) this.accept(Number(row.dataset.number));
    });
  }

  get open() { return !this.list.hidden; }

  get before() { return this.area.value.slice(0, this.area.selectionStart); }

  typed(event) {
    clearTimeout(this.timer);
    this.asked += 1;
    const line = this.before.split("\n").pop();
    const adds = !event.inputType || event.inputType.startsWith("insert");
    if (adds && ASKS.test(line) && !event.inputType?.includes("Paste")) this.timer = setTimeout(() => this.ask(), WAIT);
    else this.close();
  }

  // forced: by the user, also where the word is whole
  async ask(forced = false) {
    const mine = ++this.asked;
    const before = this.before;
    const answer = await ask("complete", {text: before, key: this.key()}).catch(() => ({}));
    if (mine !== this.asked || before !== this.before) return;
    this.word = answer.word || "";
    const found = answer.proposals || [];
    const whole = found.some((one) => one.text === this.word);
    this.show(whole && !forced ? [] : found);
  }

  show(proposals) {
    this.proposals = proposals;
    this.chosen = 0;
    if (!proposals.length) return this.close();
    this.list.replaceChildren(...proposals.map((one, number) => {
      const row = make("li", {id: `proposal-${number}`},
        make("b", {textContent: one.text}), make("span", {textContent: one.doc}));
      row.setAttribute("role", "option");
      row.dataset.number = number;
      return row;
    }));
    this.list.hidden = false;
    this.place();
    this.moved = false;
    this.choose(0);
  }

  // below the word, or above it where there is more room
  place() {
    const style = getComputedStyle(this.area);
    const pen = document.createElement("canvas").getContext("2d");
    pen.font = style.font;
    const lines = this.before.split("\n");
    const high = parseFloat(style.lineHeight);
    const start = lines[lines.length - 1].slice(0, lines[lines.length - 1].length - this.word.length);
    const box = this.area.getBoundingClientRect();
    const left = box.left + parseFloat(style.paddingLeft) + pen.measureText(start).width - this.area.scrollLeft;
    const top = box.top + parseFloat(style.paddingTop) + (lines.length - 1) * high - this.area.scrollTop;
    const below = window.innerHeight - top - high > this.list.offsetHeight;
    this.list.style.left = `${Math.max(0, Math.min(left, window.innerWidth - this.list.offsetWidth))}px`;
    this.list.style.top = `${below ? top + high : Math.max(0, top - this.list.offsetHeight)}px`;
  }

  choose(number) {
    this.chosen = (number + this.proposals.length) % this.proposals.length;
    [...this.list.children].forEach((row, n) => row.setAttribute("aria-selected", String(n === this.chosen)));
    this.list.children[this.chosen].scrollIntoView({block: "nearest"});
    this.area.setAttribute("aria-activedescendant", `proposal-${this.chosen}`);
  }

  close() {
    clearTimeout(this.timer);
    this.asked += 1;  // an answer that is on its way is too late
    this.list.hidden = true;
    this.area.removeAttribute("aria-activedescendant");
  }

  press(event) {
    if (event.key === " " && event.ctrlKey) {
      event.preventDefault();
      this.ask(true);
    } else if (!this.open || event.ctrlKey || event.metaKey || event.altKey) return;
    else if (event.key === "ArrowDown") this.go(event, 1);
    else if (event.key === "ArrowUp") this.go(event, -1);
    else if (event.key === "Escape") this.end(event);
    else if ((event.key === "Enter" || event.key === "Tab") && (this.word || this.moved)) {
      event.preventDefault();  // where nothing was typed or chosen, Enter is a new line
      this.accept(this.chosen);
    } else if (event.key.startsWith("Arrow") || event.key === "Home" || event.key === "End") this.close();
  }

  go(event, step) {
    event.preventDefault();
    this.moved = true;
    this.choose(this.chosen + step);
  }

  end(event) {
    event.preventDefault();
    this.close();
  }

  accept(number) {
    const one = this.proposals[number];
    const end = this.area.selectionStart;
    let text = one.insert || one.text;
    if (text.endsWith(": ") && /^ *:/.test(this.area.value.slice(end))) text = text.slice(0, -2);
    this.close();
    this.area.setSelectionRange(end - this.word.length, end);
    if (!document.execCommand("insertText", false, text)) {  // it keeps what Ctrl-Z needs
      this.area.setRangeText(text, end - this.word.length, end, "end");
      this.area.dispatchEvent(new Event("input", {bubbles: true}));
    }
  }
}
