// Runs, of which the latest wins: one is under way, and only the newest wish waits.

import {ask} from "./api.js";

const PATIENCE = 150;  // ms: a run that takes longer is given up for a newer wish

export class Runner {
  constructor(request, shown) {
    this.request = request;  // what to ask for now; null: nothing can be run
    this.shown = shown;
    this.number = 0;
    this.newest = 0;
    this.wanted = false;
    this.under = null;
  }

  wish() {
    this.wanted = true;
    this.go();
  }

  async go() {
    if (!this.wanted) return;
    if (this.under) {
      const wait = PATIENCE - (performance.now() - this.under.began);
      clearTimeout(this.timer);
      if (wait > 0) {
        this.timer = setTimeout(() => this.go(), wait);
        return;
      }
    }
    const request = this.request();
    this.wanted = false;
    if (request === null) return;
    const mine = {number: ++this.number, began: performance.now()};
    this.under = mine;
    let answer;
    try {
      answer = await ask("run", {...request, number: mine.number});
    } catch (error) {
      answer = {problems: [{text: lost(error)}]};
    }
    if (this.under === mine) this.under = null;
    if (!answer.superseded && mine.number > this.newest) {
      this.newest = mine.number;
      this.shown(answer, performance.now() - mine.began);
    }
    this.go();
  }

  get busy() { return this.under !== null && performance.now() - this.under.began > 300; }
}

export function lost(error) {
  if (error instanceof TypeError) {
    return "The server of this page has ended. Start `tracewire view` again, and open its new address.";
  }
  return error.message;
}
