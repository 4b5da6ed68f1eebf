// A slider and a field for each parameter. Values go out in SI, and are shown in the file's unit.

import {make, part, shown} from "./page.js";

const STEPS = 1000;
const MANY = 10;  // with more parameters there is a field to find one

export class Parameters {
  constructor(changed, jump) {
    this.changed = changed;
    this.jump = jump;
    this.rows = new Map();
    this.values = new Map();  // those that were changed, in the file's unit
    part("reset").addEventListener("click", () => this.reset());
    part("filter").addEventListener("input", () => this.find());
  }

  // the values that differ from the file's, in SI by name
  get inSI() {
    const found = {};
    for (const [name, value] of this.values) found[name] = value * this.rows.get(name).given.factor;
    return found;
  }

  // a value that was changed stays, unless the text says another one now
  show(given) {
    const before = this.rows;
    const names = given.map((one) => one.name).join("\n");
    const same = names === [...before.keys()].join("\n");
    for (const one of given) {
      const old = before.get(one.name);
      if (old && old.given.value !== one.value) this.values.delete(one.name);
    }
    const known = new Set(given.filter((one) => !one.follows).map((one) => one.name));
    for (const name of [...this.values.keys()]) if (!known.has(name)) this.values.delete(name);
    if (!same) {
      this.rows = new Map();
      part("sliders").replaceChildren(...given.map((one) => this.row(one)));
      part("filter").hidden = given.length <= MANY;
      this.find();
    }
    for (const one of given) {
      const row = this.rows.get(one.name);
      row.given = one;
      this.place(row);
    }
    this.tell();
  }

  row(given) {
    const id = `p-${given.name}`;
    const slider = make("input", {type: "range", min: 0, max: STEPS, step: 1, id});
    const field = make("input", {type: "number", step: "any", ariaLabel: `${given.name}, number`});
    const unit = make("span", {className: "unit", textContent: given.unit});
    const undo = make("button", {type: "button", className: "undo", textContent: "↺",
      title: "Back to the value of the file", ariaLabel: `${given.name}: back to the value of the file`});
    const label = make("label", {for: id, textContent: given.name});
    const formula = make("span", {className: "formula"});
    const row = {given, slider, field, undo, unit, formula,
      box: make("div", {className: "parameter"}, label, field, unit, undo, slider, formula)};
    slider.addEventListener("input", () => this.set(row, position(row.given, +slider.value), slider));
    field.addEventListener("input", () => {
      if (field.value !== "" && Number.isFinite(+field.value)) this.set(row, +field.value, field);
    });
    field.addEventListener("blur", () => this.place(row));
    undo.addEventListener("click", () => { this.forget(row); slider.focus(); });
    label.addEventListener("dblclick", () => this.jump(row.given.line));
    this.rows.set(given.name, row);
    return row.box;
  }

  set(row, value, from) {
    this.values.set(row.given.name, value);
    this.place(row, from);
    this.tell();
    this.changed();
  }

  forget(row) {
    this.values.delete(row.given.name);
    this.place(row);
    this.tell();
    this.changed();
  }

  reset() {
    this.values.clear();
    for (const row of this.rows.values()) this.place(row);
    this.tell();
    this.changed();
  }

  // show the value of a parameter everywhere but where it was just entered
  place(row, from = null) {
    const {given, slider, field} = row;
    const moved = this.values.has(given.name);
    const value = moved ? this.values.get(given.name) : given.value;
    const text = shown(value);
    if (from !== slider) slider.value = whereabouts(given, value);
    if (from !== field) field.value = text;
    slider.setAttribute("aria-valuetext", `${text} ${given.unit}`.trim());
    row.unit.textContent = given.unit;
    row.formula.textContent = given.follows ? `= ${given.follows}` : "";
    row.slider.hidden = Boolean(given.follows);
    row.field.readOnly = Boolean(given.follows);
    row.box.classList.toggle("changed", moved);
    row.box.classList.toggle("free", given.free);
    row.box.title = given.free ? "A fit may change it" : "";
    row.undo.hidden = !moved;
  }

  // the values of those that follow others, in SI; the starts that the measured series gives cannot be moved
  follow(values, overruled) {
    for (const [name, row] of this.rows) {
      const given = overruled.includes(name);
      row.slider.disabled = row.field.disabled = given;
      if (!row.given.follows) row.formula.textContent = given ? "as the measured series begins" : "";
    }
    for (const [name, value] of Object.entries(values)) {
      const row = this.rows.get(name);
      if (row && row.given.follows) row.field.value = shown(value / row.given.factor);
    }
  }

  tell() {
    part("reset").disabled = part("put").disabled = this.values.size === 0;
  }

  find() {
    const text = part("filter").hidden ? "" : part("filter").value.trim().toLowerCase();
    for (const [name, row] of this.rows) row.box.hidden = !name.toLowerCase().includes(text);
  }
}

// the value at a place of a slider, 0 to STEPS, and the place of a value
function position(given, at) {
  const s = at / STEPS;
  if (given.logarithmic) return +(given.low * (given.high / given.low) ** s).toPrecision(4);
  const value = given.low + (given.high - given.low) * s;
  const digits = Math.max(0, 3 - Math.floor(Math.log10(given.high - given.low)));
  return digits > 15 ? value : +value.toFixed(digits);
}

function whereabouts(given, value) {
  const s = given.logarithmic
    ? Math.log(value / given.low) / Math.log(given.high / given.low)
    : (value - given.low) / (given.high - given.low);
  return Math.round(STEPS * Math.min(1, Math.max(0, Number.isFinite(s) ? s : 0)));
}
