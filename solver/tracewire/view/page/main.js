// The page as a whole: the text is read, its model is run as the sliders say, and all is shown.

import {ask} from "./api.js";
import {showDrawing} from "./drawing.js";
import {Editor} from "./editor.js";
import {download, make, part, shown} from "./page.js";
import {Parameters} from "./parameters.js";
import {Plots, unitOf} from "./plots.js";
import {Runner, lost} from "./runner.js";
import {Scene} from "./scene.js";
import {Work} from "./work.js";

const TYPING = 200;  // ms without a key before the text is read
const LOOK = 500;    // ms between two looks at the file

const state = {key: "", drawn: "", names: "", runs: false, path: "", saved: "", digest: "", seen: "", present: false, ended: false};
const plots = new Plots();
const scene = new Scene((time) => plots.point(time));
const runner = new Runner(wanted, ran);
const parameters = new Parameters(() => { work.lookAway(); runner.wish(); }, (line) => editor.jump(line));
const editor = new Editor(() => { tellSaved(); typed(); }, () => state.names);

const work = new Work({
  request: own,
  drawn: (svg) => showDrawing(svg, (block) => editor.find(block)),
  taken: (text) => { parameters.values.clear(); replaceText(text); },
  refused: () => picture(reading),
  previewed: () => runner.wish(),
});

// a run of the text with the values of the sliders
function own() {
  if (!state.runs) return null;
  return {key: state.key, parameters: parameters.inSI, ...conditions()};
}

// the run that is shown: that of a proposal while it is looked at
function wanted() {
  return work.key ? {key: work.key, parameters: {}, ...conditions()} : own();
}

function conditions() { return {preset: part("preset").value, series: part("series").value}; }

function tell(text) { part("status").textContent = text; }

// --- a run ---------------------------------------------------------------------------------------

function fail(problems) {
  part("failure").replaceChildren(...problems.map((one) => make("p", {textContent: one.text})));
  part("failure").hidden = false;
  part("curves").classList.add("failed");
  part("curves").classList.remove("old");
  part("events").textContent = part("criterion").textContent = "";
  part("warnings").replaceChildren();
  scene.hide();
  tell("");
}

function ran(answer, milliseconds) {
  if (answer.problems) {
    fail(answer.problems);
    drawn(answer.number);
    return;
  }
  part("failure").hidden = true;
  part("curves").classList.remove("failed", "old");
  plots.show(answer);
  scene.show(answer);
  parameters.follow(answer.followed, answer.overruled);
  tell(`run: ${shown(1000 * answer.run_seconds, 2)} ms, shown after ${Math.round(milliseconds)} ms`);
  part("criterion").textContent = criterion(answer);
  part("events").textContent = events(answer);
  part("warnings").replaceChildren(...answer.warnings.map((one) => make("li", {textContent: one})));
  drawn(answer.number);
}

// for programs that look at the page: the number of the run that it shows
function drawn(number) { document.body.dataset.shown = number ?? ""; }

function criterion(answer) {
  const measured = answer.measured;
  if (!measured || measured.criterion === undefined) return "";
  const rms = Object.entries(measured.signals).map(([name, one]) =>
    `${name} ${shown(one.rms, 4)} ${unitOf(answer, name)}`.trim());
  return `Criterion of ${measured.name}: ${shown(measured.criterion, 6)}; rms of the residual: ${rms.join(", ")}`;
}

function events(answer) {
  const counts = new Map();
  for (const {block, kind} of answer.events) {
    const kinds = counts.get(block) || new Map();
    counts.set(block, kinds.set(kind, (kinds.get(kind) || 0) + 1));
  }
  const words = [...counts].map(([block, kinds]) =>
    `${block || "diagram"}: ${[...kinds].map(([kind, n]) => `${n} ${kind}`).join(", ")}`);
  const more = answer.event_count - answer.events.length;
  if (more > 0) words.push(`${more} more`);
  return words.length ? `Events: ${words.join("; ")}` : "No events.";
}

setInterval(() => {
  if (runner.busy) {
    part("curves").classList.add("old");
    tell("simulating …");
  }
}, 100);

// --- the text ------------------------------------------------------------------------------------

let timer = 0, reading = 0;

function typed() {
  clearTimeout(timer);
  timer = setTimeout(read, TYPING);
}

async function read() {
  const mine = ++reading;
  work.lookAway();
  let answer;
  try {
    answer = await ask("read", {text: editor.text});
  } catch (error) {
    answer = {problems: [{text: lost(error)}]};
  }
  if (mine !== reading) return;
  editor.mark(answer.problems, state.path);
  state.key = answer.key || "";
  if (answer.drawn) state.names = state.key;
  state.runs = Boolean(answer.runs);
  if (!state.runs) {
    const many = answer.problems.length;
    fail([{text: `The text has ${many === 1 ? "a mistake" : `${many} mistakes`}, and cannot be run.`},
      ...answer.problems.slice(0, 3).map((one) => ({text: one.text.replace(`${state.path}:`, "line ")}))]);
  } else {
    part("title").textContent = document.title = answer.title;
    choices("preset", answer.presets);
    choices("series", answer.series, answer.needs_series);
    part("work").hidden = state.present || !answer.fits;
    parameters.show(answer.parameters);
    runner.wish();
  }
  if (state.key) picture(mine);
}

async function picture(mine) {
  part("drawing").classList.add("old");
  const key = state.key;
  const answer = await ask("draw", {key, like: state.drawn})
    .catch((error) => ({problems: [{text: lost(error)}]}));
  if (mine !== reading) return;
  part("drawing").classList.remove("old");
  if (answer.svg) {
    state.drawn = key;
    showDrawing(answer.svg, (block) => editor.find(block));
  } else part("drawing").replaceChildren(make("p", {textContent: answer.problems[0].text}));
}

// needed: the first one is chosen where none was
function choices(id, names, needed = false) {
  const before = part(id).value;
  part(id).replaceChildren(make("option", {value: "", textContent: "none"}),
    ...names.map((name) => make("option", {value: name, textContent: name})));
  part(id).value = names.includes(before) ? before : (needed && names[0]) || "";
  part(`${id}-box`).hidden = !names.length;
  part("preset").disabled = part("series").value !== "";
}

for (const id of ["preset", "series"]) {
  part(id).addEventListener("change", () => {
    part("preset").disabled = part("series").value !== "";  // a series has its own
    runner.wish();
  });
}

// --- the file ------------------------------------------------------------------------------------

const changed = () => editor.text !== state.saved;

function tellSaved() {
  part("save").disabled = !changed();
  part("saved").textContent = changed() ? "not saved" : "saved";
  part("saved").classList.toggle("unsaved", changed());
}

function take(text, digest) {
  state.saved = text.replace(/\r\n?/g, "\n");  // as a text area has it
  state.ends = text.includes("\r\n") ? "\r\n" : "\n";
  state.digest = state.seen = digest;
  editor.text = state.saved;
  notice();
  tellSaved();
}

function notice(text = "", ...choices) {
  part("notice").hidden = !text;
  part("notice").replaceChildren(make("p", {textContent: text}),
    ...choices.map(([words, act]) => make("button", {type: "button", textContent: words, onclick: act})));
}

async function save(over = false) {
  const text = editor.text;
  const answer = await ask("save", {text: text.replaceAll("\n", state.ends), digest: state.digest, over})
    .catch((error) => ({problems: [{text: lost(error)}]}));
  if (answer.problems) notice(answer.problems[0].text, ["Close", () => notice()]);
  else if (answer.conflict) conflict();
  else {
    state.saved = text;
    state.digest = state.seen = answer.digest;
    notice();
    tellSaved();
  }
}

function conflict() {
  notice("The file was changed by another program, and the text here was changed, too.",
    ["Take the file's text", reopen], ["Write this text over the file", () => save(true)]);
}

async function reopen() {
  const file = await ask("open");
  if (file.problems) return notice(file.problems[0].text);
  take(file.text, file.digest);
  await read();
}

async function look() {
  try {
    const answer = await ask("state", {key: state.key});
    if (state.ended) notice();
    state.ended = false;
    if (answer.problems) {
      state.ended = true;  // the file cannot be read now
      notice(answer.problems[0].text);
    } else if (answer.digest !== state.seen) {
      state.seen = answer.digest;  // told once; what was read stays what Save compares with
      if (answer.digest === state.digest) notice();
      else if (changed()) conflict();
      else await reopen();
    } else if (!answer.fresh) await read();
    work.look(answer.job);
  } catch (error) {
    state.ended = true;
    notice(lost(error));
  }
  setTimeout(look, LOOK);
}

part("save").addEventListener("click", () => save());
part("put").addEventListener("click", async () => {
  const answer = await ask("put", {key: state.key, parameters: parameters.inSI});
  if (answer.problems) notice(answer.problems[0].text, ["Close", () => notice()]);
  else await replaceText(answer.text);
});

async function replaceText(text) {
  editor.text = text.replace(/\r\n?/g, "\n");
  tellSaved();
  await read();
}


for (const button of part("exports").children) {
  button.addEventListener("click", async () => {
    const request = wanted();
    if (request === null) return;
    const answer = await ask("export", {...request, kind: button.dataset.kind})
      .catch((error) => ({problems: [{text: lost(error)}]}));
    if (answer.problems) notice(answer.problems[0].text, ["Close", () => notice()]);
    else download(answer.name, answer.text, "application/octet-stream");
  });
}
document.addEventListener("keydown", (event) => {
  if ((event.ctrlKey || event.metaKey) && event.key === "s" && !state.present) {
    event.preventDefault();
    if (changed()) save();
  }
});
window.addEventListener("beforeunload", (event) => { if (changed()) event.preventDefault(); });

async function begin() {
  const file = await ask("open");
  if (file.problems) return fail(file.problems);
  state.path = file.path;
  state.present = file.present;
  document.body.classList.toggle("present", file.present);
  part("text").hidden = file.present;
  take(file.text, file.digest);
  await read();
  setTimeout(look, LOOK);
}

begin().catch((error) => fail([{text: lost(error)}]));
