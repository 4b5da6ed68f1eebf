// Fits and traces: begun by a button, told while they run, and what they propose taken or refused.

import {ask} from "./api.js";
import {make, part} from "./page.js";
import {lost} from "./runner.js";

export class Work {
  // request: what a run would ask for now; drawn: shows a picture; taken: gets a text;
  // refused: redraws; previewed: runs what `key` says, a proposal or, where it is empty, the text
  constructor({request, drawn, taken, refused, previewed}) {
    Object.assign(this, {request, drawn, taken, refused, previewed});
    this.id = null;
    this.key = "";
    this.shown = false;
    for (const kind of ["fit", "trace"]) part(kind).addEventListener("click", () => this.begin(kind));
    part("stop").addEventListener("click", () => ask("stop").catch(() => null));
    part("accept").addEventListener("click", () => this.accept());
    part("refuse").addEventListener("click", () => { this.close(); this.refused(); this.previewed(); });
    part("preview").addEventListener("change", () => this.preview());
  }

  async begin(kind) {
    const request = this.request();
    if (request === null) return this.tell("Repair the mistakes of the text first.");
    this.close();
    this.previewed();
    const answer = await ask("start", {...request, kind}).catch(failed);
    if (answer.problems) return this.tell(answer.problems[0].text);
    this.id = answer.id;
    this.busy(true);
    this.look(answer);
  }

  // job: what the server tells of the newest work, or null
  look(job) {
    if (!job || this.shown) return;
    const own = job.id === this.id;
    if (!own && job.done) return this.busy(false);
    const whose = own ? "" : "another page: ";
    if (!job.done) {
      this.busy(true);
      this.tell(`${whose}${job.kind}, ${Math.round(job.seconds)} s: ${job.text}`);
    } else if (!this.asking) this.finish();
  }

  async finish() {
    this.asking = true;
    const answer = await ask("proposal", {id: this.id}).catch(failed);
    this.asking = false;
    this.shown = true;
    this.busy(false);
    if (answer.problems) return this.tell(answer.problems.map((one) => one.text).join(" "));
    this.tell("");
    part("proposal-words").replaceChildren(...answer.words.map((text) => make("p", {textContent: text})));
    this.list(answer.effects);
    part("report").href = `report-${this.id}.html`;
    part("proposal").hidden = false;
    part("preview").checked = true;
    this.propose(answer);
  }

  // what is proposed: its text, and its picture
  propose(answer) {
    this.text = answer.text;
    this.drawn(answer.svg);
    this.preview();
  }

  // the curves of what is proposed, where they are wanted
  async preview() {
    const text = part("preview").checked ? this.text : "";
    const mine = this.looking = {};
    const answer = text ? await ask("read", {text}).catch(failed) : {};
    if (mine !== this.looking) return;
    this.key = answer.runs ? answer.key : "";
    this.previewed();
  }

  // the curves are those of the text and the sliders again
  lookAway() {
    part("preview").checked = false;
    this.looking = null;
    this.key = "";
  }

  // a box to tick for each effect of a trace
  list(effects) {
    this.boxes = effects.map((one) => make("input", {type: "checkbox", checked: true, value: one.name,
      onchange: () => this.choose()}));
    part("effects").replaceChildren(make("legend", {textContent: "Effects to take"}),
      ...effects.map((one, n) => make("label", {}, this.boxes[n], `${one.name}: ${one.words}`)),
      make("p", {id: "chosen", role: "status"}));
    part("effects").hidden = !effects.length;
  }

  // the proposal with the effects that are ticked; the newest choice counts
  async choose() {
    const names = this.boxes.filter((box) => box.checked).map((box) => box.value);
    const mine = this.choice = {};
    part("accept").disabled = true;  // until the text is that of this choice
    const answer = await ask("proposal", {id: this.id, effects: names}).catch(failed);
    if (mine !== this.choice) return;
    part("accept").disabled = !names.length || Boolean(answer.problems);
    part("chosen").textContent = answer.problems ? answer.problems[0].text
      : names.length && names.length < this.boxes.length
        ? "The values were fitted with all effects. Take these, and fit again." : "";
    if (!answer.problems) this.propose(answer);
  }

  accept() {
    const text = this.text;
    this.close();
    this.taken(text);
  }

  close() {
    this.lookAway();
    this.id = this.choice = null;
    part("accept").disabled = false;
    this.shown = false;
    part("proposal").hidden = true;
    this.tell("");
  }

  busy(on) {
    part("stop").hidden = !on;
    part("fit").disabled = part("trace").disabled = on;
    if (!on && !this.id) this.tell("");
  }

  tell(text) { part("progress").textContent = text; }
}

function failed(error) { return {problems: [{text: lost(error)}]}; }
