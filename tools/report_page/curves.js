"use strict";
// Which curves of a run are drawn together, and where their numbers come from.

const AXES = ["x", "y", "z"];

/// Plots of history.csv: each has choices by name, each choice a list of columns. `sum`: added up from
/// the start. `hasWater`: otherwise the volume of the liquid is that of all cells, and tells nothing.
function historyPlots(dimension, hasWater) {
  const byAxis = (columns) => Object.fromEntries(AXES.slice(0, dimension).map((axis) => [axis,
    columns.map(({ column, ...rest }) => ({ column: `${column}_${axis}`, ...rest }))]));
  const one = (...columns) => ({ "": columns.map(([column, label]) => ({ column, label })) });
  return [
    { title: "Momentum ledger", unit: "kg m/s", chosen: "x",  // upwards the weight hides the rest
      choices: byAxis([{ column: "fluid_momentum", label: "fluid" }, { column: "solid_momentum", label: "solids" },
        { column: "boundary_impulse", label: "from walls and sides, so far", sum: true },
        { column: "transport_change", label: "by advection, so far", sum: true }]) },
    { title: "Momentum audit: error", unit: "1", isLog: true, choices: one(["momentum_error", "linear"], ["angular_momentum_error", "angular"]) },
    { title: "Energy", unit: "J", choices: one(["fluid_kinetic_energy", "kinetic, fluid"], ["solid_kinetic_energy", "kinetic, solids"], ["elastic_energy", "elastic"]) },
    { title: "Iterations", unit: "", choices: one(["s1_iterations", "S1"], ["f2_iterations", "F2"], ["s2_iterations", "S2"], ["viscous_iterations", "viscous"], ["solid_iterations", "of the solids' block"]) },
    { title: "Time step", unit: "s", choices: one(["dt", "dt"]) },
    { title: "CFL number", unit: "", choices: one(["cfl", "CFL"]) },
    ...(hasWater ? [{ title: "Volume of liquid", unit: dimension === 3 ? "m³" : "m²", choices: one(["liquid_volume", "volume"], ["liquid_volume_target", "target"]) }] : []),
    { title: "Residuals", unit: "1", isLog: true, choices: one(["s1_residual", "S1"], ["f2_residual", "F2"], ["s2_residual", "S2"]) },
    { title: "Largest divergence", unit: "1/s", isLog: true, choices: one(["max_divergence", "divergence"]) },
    { title: "Contacts", unit: "", choices: one(["contacts", "contact points"]) },
    { title: "Wall time of a step", unit: "s", choices: one(["wall_seconds", "wall time"]) },
  ];
}

function showsWater(run) {
  return run.frames.some((frame) => frame.surfaces.some(({ water }) => water));
}

/// A table packed for the page is one of rows by time, or has one for each name of a body, a joint, ...
function partsOf(table) {
  return table.named ? Object.values(table.named) : [table];
}

const TITLES = { "bodies.csv": "Bodies", "joints.csv": "Joints" };

/// Bodies, joints and other things that have names: a choice for each column, a curve for each name.
function namedPlot(file, { named }, up) {
  const names = Object.keys(named), { columns } = named[names[0]];
  const choices = {};
  for (const { name, unit } of columns.filter((column) => !["step", "time"].includes(column.name)))
    choices[unit && unit !== "1" ? `${name} [${unit}]` : name] = names.map((one) => ({ named: one, column: name, label: one }));
  return { title: TITLES[file] ?? file.replace(/\.csv$/, ""), unit: "", chosen: Object.keys(choices)[file === "bodies.csv" ? up : 0], choices };
}

/// Any other table: a choice for each column.
function tablePlot(file, table) {
  const choices = {};
  for (const { name, unit } of table.columns.filter((column) => !["step", "time"].includes(column.name)))
    choices[unit ? `${name} [${unit}]` : name] = [{ column: name, label: name }];
  return { title: file.replace(/\.csv$/, ""), unit: "", choices };
}

/// All plots of some runs: {file, title, unit, isLog, choices, chosen}.
function plotsOf(runs) {
  const up = runs[0].view.up, hasWater = runs.some(showsWater);
  const plots = historyPlots(Math.max(...runs.map((run) => run.dimension)), hasWater).map((plot) => ({ file: "history.csv", ...plot }));
  for (const run of runs) {
    for (const [file, table] of Object.entries(run.tables)) {
      if (file === "history.csv" || plots.some((plot) => plot.file === file)) continue;
      if (partsOf(table).length) plots.push({ file, ...(table.named ? namedPlot : tablePlot)(file, table, up) });
    }
  }
  return plots.map((plot) => ({ ...plot, choices: choicesThatAre(plot, runs) })).filter(({ choices }) => Object.keys(choices).length);
}

/// The table that a curve is drawn from; undefined if the run has none.
function tableOf(run, file, named) {
  const table = run.tables[file];
  return named === undefined ? table : table?.named?.[named];
}

/// The choices of a plot for which at least one run has a column.
function choicesThatAre({ file, choices }, runs) {
  const has = ({ column, named }) => runs.some((run) => tableOf(run, file, named)?.columns.some(({ name }) => name === column));
  return Object.fromEntries(Object.entries(choices).filter(([, columns]) => columns.some(has)));
}

/// The curves of one choice: columns by colour, runs by dashes; what is zero or no number throughout is left out.
async function curvesOf(runs, plot, choice) {
  const wanted = [];
  for (const [r, run] of runs.entries()) {
    const specs = run.tables[plot.file] ? plot.choices[choice] : [];
    const alone = plot.choices[choice].length === 1;
    for (const [c, { column, label, sum, named }] of specs.entries()) {
      const table = tableOf(run, plot.file, named);
      if (!table || !table.n) continue;
      const columns = await columnsOf(table);
      if (!columns[column] || columns[column].every((value) => !value)) continue;
      const colour = CURVE_COLOURS[(alone ? r : c) % CURVE_COLOURS.length];
      wanted.push({ label: runs.length > 1 ? `${label}, ${run.label}` : label, colour, dash: alone ? "" : DASHES[r % DASHES.length],
        x: columns.time, y: sum ? sumsOf(columns[column]) : columns[column] });
    }
  }
  return wanted;
}

function sumsOf(values) {
  let sum = 0;
  return Float64Array.from(values, (value) => (sum += Number.isNaN(value) ? 0 : value));
}
