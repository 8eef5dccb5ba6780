"use strict";
// The arrays of the page by the name of their content: from the page itself or, while a run is
// watched, from the server that sent it.

const pageData = JSON.parse(document.getElementById("page-data").textContent);
const bytesByName = new Map();  // promises

function bytesOf(name) {
  if (!bytesByName.has(name)) bytesByName.set(name, loadBytes(name));
  return bytesByName.get(name);
}

async function loadBytes(name) {
  const compressed = pageData.blobs ? Uint8Array.from(atob(pageData.blobs[name]), (c) => c.charCodeAt(0))
    : new Uint8Array(await (await fetch("blobs/" + name)).arrayBuffer());
  return new Response(new Blob([compressed]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
}

/// Positions x, y, z, x, y, z, ... from 16-bit differences within a box.
async function pointsOf({ blob, n, low, size }) {
  const differences = new Uint16Array(await bytesOf(blob));
  const points = new Float32Array(3 * n);
  for (let axis = 0; axis < 3; ++axis) {
    for (let i = 0, sum = 0; i < n; ++i) {
      sum = (sum + differences[axis * n + i]) & 0xffff;
      points[3 * i + axis] = low[axis] + (sum / 65535) * size[axis];
    }
  }
  return points;
}

/// Vertex numbers of simplices, one after the other, from their differences.
async function simplicesOf({ blob }) {
  const numbers = new Uint32Array(await bytesOf(blob)).slice();
  for (let i = 1; i < numbers.length; ++i) numbers[i] += numbers[i - 1];
  return numbers;
}

/// The columns of a table by name.
async function columnsOf({ blob, n, columns }) {
  const values = new Float32Array(await bytesOf(blob));
  return Object.fromEntries(columns.map(({ name }, i) => [name, values.subarray(i * n, (i + 1) * n)]));
}

/// The layers of a field across an axis that there are.
function layersOf(field, cells, axis) {
  return field.layers ? field.layers[axis].map(({ layer }) => layer)
    : Array.from({ length: cells[axis] }, (_, k) => k);
}

/// All cells of a field, or coarser ones of a large field; null if there are layers only.
function volumeOf(field, box) {
  if (field?.blob) return { blob: field.blob, cells: box.cells, spacing: box.spacing };
  return field?.volume ? { ...field.volume, spacing: box.spacing.map((h) => h * field.volume.by) } : null;
}

/// One layer of cells across an axis: bytes 0 to 254, 255 for none; the lower of the other axes runs
/// fastest.
async function layerOf(field, cells, axis, layer) {
  if (field.layers) {
    const nearest = field.layers[axis].reduce((a, b) => (Math.abs(b.layer - layer) < Math.abs(a.layer - layer) ? b : a));
    return new Uint8Array(await bytesOf(nearest.blob));
  }
  const values = new Uint8Array(await bytesOf(field.blob));
  const strides = [1, cells[0], cells[0] * cells[1]];
  const [first, second] = [0, 1, 2].filter((other) => other !== axis);
  const picked = new Uint8Array(cells[first] * cells[second]);
  for (let j = 0, to = 0; j < cells[second]; ++j) {
    let from = layer * strides[axis] + j * strides[second];
    for (let i = 0; i < cells[first]; ++i, from += strides[first]) picked[to++] = values[from];
  }
  return picked;
}
