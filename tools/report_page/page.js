"use strict";
// Puts the page together: heads, players that go by one clock, curves, stages and parameters.

const at = (id) => document.getElementById(id);
const state = { runs: pageData.runs, time: 0, playing: false, players: [], plots: [], chosen: {}, hidden: {} };

/// Runs of one folder name are told apart by number.
function nameRuns(runs) {
  runs.forEach((run, r) => { run.label = runs.filter(({ folder }) => folder === run.folder).length > 1 ? `${run.folder} (${r + 1})` : run.folder; });
}

function fillHeads() {
  at("heads").replaceChildren(...state.runs.map((run) => {
    const [, status] = run.facts.find(([name]) => name === "state");
    const kind = status === "done" ? "done" : status.startsWith("running") ? "running" : "ended";
    const facts = make("dl", { class: "facts" });
    for (const [name, value] of run.facts.filter(([name]) => name !== "state")) facts.append(make("dt", {}, name), make("dd", {}, value));
    return make("div", {}, make("h1", {}, run.title || run.folder),
      make("span", { class: `state ${kind}` }, status), make("span", { class: "folder" }, ` ${run.label}`), facts);
  }));
}

// The clock.

function allTimes() {
  return [...new Set(state.runs.flatMap((run) => run.frames.map((frame) => frame.time)))].sort((a, b) => a - b);
}

async function setTime(time) {
  state.time = time;
  const times = allTimes();
  const last = times.filter((t) => t <= time * (1 + 1e-9) + 1e-12).length - 1;
  at("scrub").max = Math.max(times.length - 1, 0);
  at("scrub").value = Math.max(last, 0);
  at("clock").textContent = `t = ${shortNumber(time)} s, frame ${Math.max(last, 0) + 1} of ${times.length}`;
  for (const plot of state.plots) plot.setTime(time);
  await Promise.all(state.players.map((player) => player.show(time)));
}

function fillSpeeds() {
  const times = allTimes(), span = times.length ? times[times.length - 1] - times[0] : 1;
  const kept = at("speed").value;
  const nice = 10 ** Math.round(Math.log10(span / 8 || 1));
  const speeds = [0.1, 0.25, 0.5, 1, 2, 5].map((factor) => factor * nice);
  at("speed").replaceChildren(...speeds.map((speed) => make("option", { value: speed }, `${shortNumber(speed)} s each second`)));
  at("speed").value = kept && speeds.includes(Number(kept)) ? kept : speeds.reduce((a, b) => (Math.abs(b - span / 8) < Math.abs(a - span / 8) ? b : a));
}

async function play() {
  state.playing = !state.playing;
  at("play").textContent = state.playing ? "\u275A\u275A" : "\u25B6";
  if (!state.playing) return;
  const times = allTimes();
  if (state.time >= times[times.length - 1]) await setTime(times[0]);
  let before = performance.now();
  while (state.playing) {
    await new Promise(requestAnimationFrame);
    const now = performance.now(), end = allTimes().pop();
    // A picture that takes long must not be jumped over.
    const next = state.time + Math.min((now - before) / 1000, 0.2) * Number(at("speed").value);
    before = now;
    await setTime(Math.min(next, end));
    if (next >= end) play();
  }
}

// What is shown.

function fieldNames() {
  return [...new Set(state.runs.flatMap((run) => run.frames.flatMap((frame) => Object.keys(frame.fields))))];
}

/// One range of colours over all frames of all runs, so that they compare; a tenth of the frames may go
/// beyond it, so that one splash does not take the colours of all others.
function rangeOfField(name) {
  const fields = state.runs.flatMap((run) => run.frames.map((frame) => frame.fields[name])).filter(Boolean);
  const part = (values, fraction) => values.sort((a, b) => a - b)[Math.round(fraction * (values.length - 1))];
  const low = isMagnitude(name) ? 0 : part(fields.map((field) => field.low), 0.1);
  const high = part(fields.map((field) => field.high), 0.9);
  return { low, high: high > low ? high : low + 1e-9 };
}

function boxOf(run) { return run.frames.find((frame) => frame.box)?.box; }

function fillFields() {
  const kept = at("field").value, names = fieldNames();
  at("field").replaceChildren(make("option", { value: "" }, "none"),
    ...names.map((name) => make("option", { value: name }, isMagnitude(name) ? `|${name}|` : name)));
  const hasWater = state.runs.some(showsWater);
  // Water is shown by its surface, and hides a slice.
  const usual = hasWater && state.runs[0].dimension === 3 ? "" : names[0] ?? "";
  const first = state.runs.map((run) => run.view.field).find((name) => names.includes(name)) ?? usual;
  at("field").value = state.fieldsFilled ? kept : first;
  state.fieldsFilled = true;
}

function isMagnitude(name) {
  return state.runs.some((run) => run.frames.some((frame) => frame.fields[name]?.magnitude));
}

function firstAxis() {
  // Across the direction that the first view looks along.
  return state.runs[0].view.up === 2 ? 1 : 2;
}

function canBeCloud(name) {
  return state.players.some(({ cloud, run }) => cloud && (CLOUDY.includes(name) || (run.view.volume && run.view.field === name)) &&
    run.frames.some((frame) => !frame.fields[name]?.magnitude && volumeOf(frame.fields[name], frame.box)));
}

/// The layer as a part of the axis: runs may differ in their cells.
function applyField(keepLayer) {
  const name = at("field").value, axis = AXES.indexOf(at("axis").value);
  const boxes = state.runs.map(boxOf);
  const reference = boxes.find(Boolean), n = reference ? reference.cells[axis] : 1;
  at("layer").max = n - 1;
  if (!keepLayer) at("layer").value = Math.floor(n / 2);
  const part = (Number(at("layer").value) + 0.5) / n;
  const range = name ? rangeOfField(name) : null;
  const asCloud = canBeCloud(name) && at("style").value === "cloud";
  state.players.forEach((player, r) => {
    if (!boxes[r]) return;
    const field = player.run.frames.map((frame) => frame.fields[name]).find(Boolean);
    const wanted = Math.floor(part * boxes[r].cells[axis]);
    const layers = field ? layersOf(field, boxes[r].cells, axis) : [wanted];
    const layer = layers.reduce((a, b) => (Math.abs(b - wanted) < Math.abs(a - wanted) ? b : a));
    Object.assign(player.settings, { field: name, axis, layer, range, asCloud });
    if (r === 0) at("position").textContent = `${AXES[axis]} = ${shortNumber(boxes[r].origin[axis] + (layer + 0.5) * boxes[r].spacing[axis])} m`;
  });
  const isSlice = Boolean(name) && !asCloud && state.runs[0].dimension === 3;
  at("as").hidden = !canBeCloud(name);
  for (const element of document.querySelectorAll(".of-slice")) element.hidden = !isSlice;
  at("colours").hidden = !name || (asCloud && name === "smoke");
  if (name) { at("low").textContent = shortNumber(range.low); at("high").textContent = shortNumber(range.high); }
  return setTime(state.time);
}

function drawBar() {
  const context = at("bar").getContext("2d"), image = context.createImageData(256, 1);
  for (let i = 0; i < 256; ++i) image.data.set([...viridis(i / 255), 255], 4 * i);
  context.putImageData(image, 0, 0);
}

function addToggles() {
  for (const name of ["solids", "water", "paths", "box"]) {
    const box = make("input", { type: "checkbox" });
    box.checked = true;
    box.addEventListener("change", () => {
      for (const player of state.players) player.settings[name] = box.checked;
      setTime(state.time);
    });
    at("toggles").append(make("label", {}, box, ` ${name}`));
  }
}

// Players.

function addPlayers() {
  for (const run of state.runs) {
    const element = make("div", { class: "player" });
    at("players").append(element);
    if (state.runs.length > 1) element.append(make("div", { class: "name" }, run.label));
    const player = new Player(element, run);
    if (!run.frames.length) element.append(make("div", { class: "none" }, "no frames"));
    state.players.push(player);
  }
  for (const player of state.players) player.onTurned = () => turnOthers(player);
}

let turning = false;

/// Runs in the same domain are looked at from the same place.
function turnOthers(player) {
  if (turning) return;
  turning = true;
  for (const other of state.players) {
    if (other === player || JSON.stringify(other.run.domain) !== JSON.stringify(player.run.domain)) continue;
    other.camera.position.copy(player.camera.position);
    other.camera.zoom = player.camera.zoom;
    other.camera.updateProjectionMatrix();
    other.controls.target.copy(player.controls.target);
    other.controls.update();
    other.draw();
  }
  turning = false;
}

// Below the players.

async function fillPlots() {
  const plots = [];
  for (const plot of plotsOf(state.runs)) {
    const key = `${plot.file} ${plot.title}`, names = Object.keys(plot.choices);
    const chosen = state.chosen[key] ?? (names.includes(plot.chosen) ? plot.chosen : names[0]);
    const curves = names.length ? await curvesOf(state.runs, plot, chosen) : [];
    if (!curves.length && names.length < 2) continue;
    state.hidden[key] ??= new Set();
    plots.push(new Plot({ ...plot, curves, choices: names.length > 1 ? names : null, chosen, hidden: state.hidden[key],
      onChoice: (name) => { state.chosen[key] = name; fillPlots(); },
      onTime: (time) => setTime(nearestFrame(time)) }));
  }
  state.plots = plots;
  at("plots").replaceChildren(...plots.map((plot) => plot.element));
  for (const plot of plots) plot.setTime(state.time);
}

function nearestFrame(time) {
  return allTimes().reduce((a, b) => (Math.abs(b - time) < Math.abs(a - time) ? b : a), 0);
}

function fillPhases() {
  at("stages").replaceChildren(...state.runs.map((run) => {
    if (!run.stages.length) return make("p", { class: "note" }, "Told when the run has ended.");
    const total = run.stages.filter(({ name }) => !name.includes(" / ")).reduce((sum, stage) => sum + stage.max_seconds, 0);
    const rows = run.stages.filter((stage) => stage.max_seconds > 0.004 * total).map((stage) => {
      const depth = stage.name.split(" / ").length - 1;
      const label = make("td", { style: `padding-left: ${18 * depth}px` }, stage.name.split(" / ").pop());
      const bar = make("span", { class: "share", style: `width: ${(100 * stage.mean_seconds) / total}%; opacity: ${1 - 0.25 * Math.min(depth, 3)}` });
      const ranks = stage.max_seconds > 1.02 * stage.min_seconds ? ` (${shortNumber(stage.min_seconds)} to ${shortNumber(stage.max_seconds)})` : "";
      return make("tr", {}, label, make("td", {}, bar), make("td", { class: "number" }, `${shortNumber(stage.mean_seconds)} s${ranks}`),
        make("td", { class: "number" }, `${stage.calls} ×`));
    });
    return make("table", { class: "stages" }, ...rows);
  }));
}

function parameterTable(rows, heads) {
  return make("table", {}, make("tr", {}, ...heads.map((head) => make("th", {}, head))),
    ...rows.map((row) => make("tr", {}, ...row.map((word) => make("td", {}, word)))));
}

function fillDetails() {
  const parts = [];
  if (pageData.differences?.length) {
    parts.push(make("details", { open: "" }, make("summary", {}, "Parameters in which the runs differ"),
      parameterTable(pageData.differences.map(([name, values]) => [name, ...values]), ["parameter", ...state.runs.map(({ label }) => label)])));
  }
  for (const run of state.runs) {
    const of = state.runs.length > 1 ? ` of ${run.label}` : "";
    parts.push(make("details", {}, make("summary", {}, `Parameters${of} that are not the defaults`), parameterTable(run.parameters, ["parameter", "value"])),
      make("details", {}, make("summary", {}, `Scene file${of}`), make("pre", {}, run.scene)));
    const thinned = Object.entries(run.tables).map(([file, table]) => [file, Math.max(1, ...partsOf(table).map(({ every }) => every))])
      .filter(([, every]) => every > 1).map(([file, every]) => `every ${every}th row of ${file}`);
    if (run.every > 1) thinned.push(`every ${run.every}th of ${run.n_written} frames`);
    if (thinned.length) parts.push(make("p", { class: "note" }, `Shown${of}: ${thinned.join(", ")}.`));
  }
  parts.push(make("p", { class: "note" }, `Written ${pageData.written} by tools/report. Positions are kept to 1/65535 of a body's size, fields to 1/254 of their range in a frame (but for a thousandth of the cells at either end).`));
  at("details").replaceChildren(...parts);
}

// A run that goes on.

/// Tables are new whenever they have grown; what they were is asked for no more.
function forgetTables(old, fresh) {
  const names = (runs) => new Set(runs.flatMap((run) => Object.values(run.tables).flatMap(partsOf).map(({ blob }) => blob)));
  const kept = names(fresh);
  for (const name of names(old)) if (!kept.has(name)) bytesByName.delete(name);
}

async function refresh() {
  const answer = await fetch("runs.json").catch(() => null);
  complain(answer === null ? "The program that watches the run has ended: what follows is the last that it told."
    : answer.ok ? "" : await answer.text());
  if (answer?.ok) await takeOver(await answer.json());
  setTimeout(refresh, 1000 * pageData.refresh);
}

function complain(text) {
  at("complaint")?.remove();
  if (text) at("heads").before(make("div", { id: "complaint" }, text));
}

/// Who looks at the end goes on looking at the end.
async function takeOver({ runs, differences }) {
  const atEnd = state.time >= (allTimes().pop() ?? 0);
  forgetTables(state.runs, runs);
  state.runs = runs;
  pageData.differences = differences;
  await fillAll();
  if (atEnd && !state.playing) await setTime(allTimes().pop() ?? 0);
}

async function fillAll() {
  nameRuns(state.runs);
  fillHeads();
  state.players.forEach((player, r) => {
    player.run = state.runs[r];
    if (player.run.frames.length) player.element.querySelector(".none")?.remove();
  });
  fillSpeeds();
  fillFields();
  await Promise.all(state.players.filter((player) => player.run.frames.length).map((player) => player.loadPaths()));
  await fillPlots();
  fillPhases();
  fillDetails();
  await applyField(state.fieldApplied);
  state.fieldApplied = true;
}

function listen() {
  at("play").addEventListener("click", play);
  at("scrub").addEventListener("input", () => setTime(allTimes()[Number(at("scrub").value)]));
  at("field").addEventListener("change", () => applyField(true));
  at("style").addEventListener("change", () => applyField(true));
  at("axis").addEventListener("change", () => applyField(false));
  at("layer").addEventListener("input", () => applyField(true));
  at("home").addEventListener("click", () => state.players.forEach((player) => player.home()));
  document.addEventListener("keydown", (event) => {
    if (["INPUT", "SELECT", "BUTTON"].includes(event.target.tagName)) return;
    if (event.key === " ") { event.preventDefault(); play(); }
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const times = allTimes();
    if (step) setTime(times[Math.min(Math.max(Number(at("scrub").value) + step, 0), times.length - 1)]);
  });
}

async function start() {
  nameRuns(state.runs);
  at("axis").value = AXES[firstAxis()];
  at("style").value = "cloud";
  drawBar();
  addToggles();
  addPlayers();
  listen();
  await fillAll();
  const times = allTimes();
  await setTime(pageData.refresh ? times.pop() ?? 0 : times[0] ?? 0);
  if (pageData.refresh) setTimeout(refresh, 1000 * pageData.refresh);
  document.body.dataset.ready = "yes";
}

start();
