"use strict";
// From points and simplices to what three.js draws.

const COS_OF_CREASE = 0.6;  // sharper edges stay edges

/// Triangles with a normal at each corner: the mean over the neighbours that are not behind a crease.
function creasedTriangles(points, triangles) {
  const n = triangles.length / 3;
  const normals = triangleNormals(points, triangles);
  const { first, around } = trianglesAround(points.length / 3, triangles);
  const lengths = Float32Array.from({ length: n }, (_, t) => Math.hypot(normals[3 * t], normals[3 * t + 1], normals[3 * t + 2]) || 1);
  const positions = new Float32Array(9 * n), directions = new Float32Array(9 * n);
  for (let corner = 0; corner < 3 * n; ++corner) {
    const t = Math.floor(corner / 3), vertex = triangles[corner];
    const nx = normals[3 * t], ny = normals[3 * t + 1], nz = normals[3 * t + 2];
    let x = 0, y = 0, z = 0;
    for (let k = first[vertex]; k < first[vertex + 1]; ++k) {
      const other = around[k];
      const ox = normals[3 * other], oy = normals[3 * other + 1], oz = normals[3 * other + 2];
      if (nx * ox + ny * oy + nz * oz >= COS_OF_CREASE * lengths[t] * lengths[other]) { x += ox; y += oy; z += oz; }
    }
    const length = Math.hypot(x, y, z) || 1;
    directions.set([x / length, y / length, z / length], 3 * corner);
    positions.set(points.subarray(3 * vertex, 3 * vertex + 3), 3 * corner);
  }
  return bufferGeometry(positions, directions);
}

/// Twice the area long.
function triangleNormals(points, triangles) {
  const normals = new Float32Array(triangles.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ux = points[b] - points[a], uy = points[b + 1] - points[a + 1], uz = points[b + 2] - points[a + 2];
    const vx = points[c] - points[a], vy = points[c + 1] - points[a + 1], vz = points[c + 2] - points[a + 2];
    normals[t] = uy * vz - uz * vy;
    normals[t + 1] = uz * vx - ux * vz;
    normals[t + 2] = ux * vy - uy * vx;
  }
  return normals;
}

/// The triangles at each vertex: around[first[vertex]] to around[first[vertex + 1] - 1].
function trianglesAround(nVertices, triangles) {
  const first = new Uint32Array(nVertices + 1);
  for (const vertex of triangles) ++first[vertex + 1];
  for (let v = 0; v < nVertices; ++v) first[v + 1] += first[v];
  const next = first.slice(), around = new Uint32Array(triangles.length);
  triangles.forEach((vertex, corner) => { around[next[vertex]++] = Math.floor(corner / 3); });
  return { first, around };
}

function bufferGeometry(positions, normals) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  if (normals) geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
  return geometry;
}

/// Segments of a plane as bands of this width, because lines are one pixel wide everywhere.
function bands(points, segments, width) {
  const positions = [];
  for (let s = 0; s < segments.length; s += 2) {
    const a = 3 * segments[s], b = 3 * segments[s + 1];
    const dx = points[b] - points[a], dy = points[b + 1] - points[a + 1];
    const scale = width / 2 / (Math.hypot(dx, dy) || 1);
    const nx = -dy * scale, ny = dx * scale, ex = dx * scale, ey = dy * scale;
    const p = [points[a] - ex + nx, points[a + 1] - ey + ny], q = [points[a] - ex - nx, points[a + 1] - ey - ny];
    const r = [points[b] + ex - nx, points[b + 1] + ey - ny], u = [points[b] + ex + nx, points[b + 1] + ey + ny];
    positions.push(...p, 0, ...q, 0, ...r, 0, ...p, 0, ...r, 0, ...u, 0);
  }
  return bufferGeometry(new Float32Array(positions));
}

/// What closed chains of segments enclose, as triangles; open chains enclose nothing.
function insides(points, segments) {
  const next = new Map();
  for (let s = 0; s < segments.length; s += 2) next.set(segments[s], segments[s + 1]);
  const positions = [];
  while (next.size) {
    const start = next.keys().next().value;
    const chain = [];
    let vertex = start;
    while (next.has(vertex)) {
      chain.push(new THREE.Vector2(points[3 * vertex], points[3 * vertex + 1]));
      const following = next.get(vertex);
      next.delete(vertex);
      vertex = following;
    }
    if (vertex !== start || chain.length < 3) continue;
    for (const triangle of THREE.ShapeUtils.triangulateShape(chain, []))
      for (const corner of triangle) positions.push(chain[corner].x, chain[corner].y, 0);
  }
  return bufferGeometry(new Float32Array(positions));
}

/// The rectangle that one layer of cells across an axis fills, at its middle.
function layerRectangle({ origin, spacing, cells }, axis, layer) {
  const [first, second] = [0, 1, 2].filter((other) => other !== axis);
  const positions = new Float32Array(12);
  [[0, 0], [1, 0], [1, 1], [0, 1]].forEach(([i, j], corner) => {
    positions[3 * corner + first] = origin[first] + i * cells[first] * spacing[first];
    positions[3 * corner + second] = origin[second] + j * cells[second] * spacing[second];
    positions[3 * corner + axis] = origin[axis] + (layer + 0.5) * spacing[axis];
  });
  const geometry = bufferGeometry(positions);
  geometry.setAttribute("uv", new THREE.BufferAttribute(new Float32Array([0, 0, 1, 0, 1, 1, 0, 1]), 2));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  return geometry;
}
