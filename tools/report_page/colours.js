"use strict";
// Colours of fields, solids and curves.

const SOLID_COLOURS = [0xcc5c40, 0x4d80b8, 0xdeb34d, 0x73a66b, 0x9473ad, 0x8c8c8c];
const WATER_COLOUR = 0x3f86c6;
const CURVE_COLOURS = ["#1f6fb2", "#d1552b", "#3a923a", "#8e5bb0", "#b8860b", "#17939e", "#c2478f", "#5c6670"];
const DASHES = ["", "6 3", "2 2", "8 3 2 3"];

// Matplotlib's viridis at nine places (CC0).
const VIRIDIS = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129],
  [92, 200, 99], [170, 220, 50], [253, 231, 37]];

/// Of a number from 0 to 1.
function viridis(x) {
  const place = Math.min(Math.max(x, 0), 1) * (VIRIDIS.length - 1);
  const k = Math.min(Math.floor(place), VIRIDIS.length - 2);
  return VIRIDIS[k].map((c, i) => Math.round(c + (place - k) * (VIRIDIS[k + 1][i] - c)));
}

/// RGBA of the 256 values of a field between low and high, in a range of colours; 255 is transparent.
function colourTable({ low, high }, range) {
  const table = new Uint8Array(4 * 256);
  for (let value = 0; value < 255; ++value) {
    const shown = low + (value / 254) * (high - low);
    table.set([...viridis((shown - range.low) / (range.high - range.low)), 255], 4 * value);
  }
  return table;
}
