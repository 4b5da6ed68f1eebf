// The mechanism of the diagram, drawn as its section `scene` says, and played in its own time.

import {part, shown} from "./page.js";
import {DRAW} from "./scene_parts.js";

const STEPS = 1000;

export class Scene {
  constructor(moved) {
    this.moved = moved;  // is told the time that is shown
    this.canvas = part("stage");
    this.time = 0;
    this.playing = false;
    part("play").addEventListener("click", () => this.play(!this.playing));
    part("time").addEventListener("input", () => {
      this.play(false);
      this.time = this.begin + (this.end - this.begin) * part("time").value / STEPS;
      this.paint();
    });
    new ResizeObserver(() => this.paint()).observe(this.canvas.parentElement);
  }

  // a new run: the time stays, and what is in sight may only grow
  show(head) {
    const scene = head.scene;
    part("scene").hidden = !scene || Boolean(scene.problem);
    part("no-scene-problem").hidden = !(scene && scene.problem);
    part("no-scene-problem").textContent = scene && scene.problem ? scene.problem : "";
    const before = this.data;
    this.data = scene && !scene.problem ? scene : null;
    if (!this.data) {
      this.play(false);
      this.moved(null);
      return;
    }
    const kinds = JSON.stringify(this.data.parts.map((one) => one.kind));
    this.arrays = head.arrays;
    this.t = head.arrays[head.t];
    const [begin, end] = [this.t[0], this.t[this.t.length - 1]];
    if (!before || begin !== this.begin || end !== this.end) this.time = begin;
    [this.begin, this.end] = [begin, end];
    const [left, right, bottom, top] = this.data.extent;
    const old = this.kinds === kinds && this.extent;
    this.extent = old
      ? [Math.min(left, old[0]), Math.max(right, old[1]), Math.min(bottom, old[2]), Math.max(top, old[3])]
      : [left, right, bottom, top];
    this.kinds = kinds;
    this.paint();
  }

  hide() {
    part("scene").hidden = true;
    this.data = null;
    this.play(false);
    this.moved(null);
  }

  play(on) {
    if (on === this.playing) return;
    this.playing = on;
    part("play").textContent = on ? "Pause" : "Play";
    part("play").setAttribute("aria-pressed", String(on));
    if (!on) return;
    if (this.time >= this.end) this.time = this.begin;
    let last = performance.now();
    const step = (now) => {
      if (!this.playing || !this.data) return;
      this.time += (now - last) / 1000 * +part("speed").value;
      last = now;
      if (this.time >= this.end) {
        this.time = this.end;
        this.play(false);
      }
      this.paint();
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  // the number of the sample next to the time
  sample() {
    let [low, high] = [0, this.t.length - 1];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.t[middle] <= this.time) low = middle;
      else high = middle;
    }
    return this.time - this.t[low] <= this.t[high] - this.time ? low : high;
  }

  paint() {
    if (!this.data) return;
    const k = this.sample();
    const [left, right, bottom, top] = this.extent;
    const wide = this.canvas.parentElement.clientWidth;
    if (!wide) return;
    const most = Math.max(160, 0.45 * window.innerHeight);
    const high = Math.min(Math.max(wide * (top - bottom) / (right - left), 0.2 * wide), most);
    const ratio = window.devicePixelRatio || 1;
    if (this.canvas.width !== Math.round(wide * ratio) || this.canvas.height !== Math.round(high * ratio)) {
      this.canvas.width = Math.round(wide * ratio);
      this.canvas.height = Math.round(high * ratio);
      this.canvas.style.height = `${high}px`;
    }
    const scale = Math.min(wide / (right - left), high / (top - bottom));
    const c = this.canvas.getContext("2d");
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, wide, high);
    const look = {
      x: (x) => wide / 2 + (x - (left + right) / 2) * scale,
      y: (y) => high / 2 - (y - (bottom + top) / 2) * scale,
      scale, size: right - left, t: this.t,
    };
    const value = (number, n) => this.arrays[number][this.arrays[number].length > 1 ? n : 0];  // one: it stays
    const order = {ground: 1, trace: 2, spring: 2.5, rod: 3, box: 3, disc: 4};
    const parts = [...this.data.parts].sort((a, b) => order[a.kind] - order[b.kind]);
    for (const one of parts) DRAW[one.kind](c, one, k, value, look);
    part("time").value = Math.round(STEPS * (this.time - this.begin) / (this.end - this.begin));
    const text = `t = ${shown(this.time, 4)} s`;
    part("clock").textContent = text;
    part("time").setAttribute("aria-valuetext", text);
    this.canvas.setAttribute("aria-label", `The mechanism at ${text}`);
    this.moved(this.time);
  }
}
