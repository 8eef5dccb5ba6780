"use strict";
// One run in three dimensions (or two): its frames by time, turned and moved with the mouse.

/// A solid or the water of one frame. Their triangles are kept as long as neither points nor simplices
/// change, as those of bodies that rest.
class Surface {
  constructor(group, colour, isWater, dimension, lineWidth) {
    this.isWater = isWater;
    this.dimension = dimension;
    this.lineWidth = lineWidth;
    this.parts = dimension === 2 ? flatParts(colour, isWater) : isWater ? waterParts() : solidParts(colour);
    for (const part of this.parts) group.add(part);
    this.shown = "";
  }

  async load({ points, simplices }) {
    const key = JSON.stringify([points, simplices]);
    if (key === this.shown) return () => {};
    const [places, numbers] = await Promise.all([pointsOf(points), simplicesOf(simplices)]);
    const geometries = this.dimension === 2 ? [insides(places, numbers), bands(places, numbers, this.lineWidth)]
      : [creasedTriangles(places, numbers)];
    return () => {
      this.shown = key;
      this.parts.forEach((part, i) => {
        part.geometry.dispose();
        part.geometry = geometries[i % geometries.length];
      });
    };
  }

  set visible(isVisible) { for (const part of this.parts) part.visible = isVisible; }
}

function solidParts(colour) {
  const material = new THREE.MeshPhongMaterial({ color: colour, side: THREE.DoubleSide, specular: 0x333333, shininess: 30 });
  return [new THREE.Mesh(new THREE.BufferGeometry(), material)];
}

/// The far side first, so that the near one shines upon it.
function waterParts() {
  return [THREE.BackSide, THREE.FrontSide].map((side, order) => {
    const material = new THREE.MeshPhongMaterial({ color: WATER_COLOUR, side, transparent: true, opacity: order ? 0.38 : 0.25,
      depthWrite: false, specular: 0x9aa4ae, shininess: 80 });
    const mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    mesh.renderOrder = 1 + order;
    return mesh;
  });
}

/// What is inside, and the outline.
function flatParts(colour, isWater) {
  const inside = new THREE.MeshBasicMaterial({ color: colour, side: THREE.DoubleSide, transparent: isWater, opacity: isWater ? 0.25 : 1 });
  const line = new THREE.MeshBasicMaterial({ color: new THREE.Color(colour).multiplyScalar(0.7), side: THREE.DoubleSide });
  return [inside, line].map((material, order) => {
    const mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    mesh.renderOrder = 1 + order;
    mesh.position.z = 1e-3 * order;
    return mesh;
  });
}

class Player {
  constructor(element, run) {
    this.element = element;
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("webgl2", { antialias: true, alpha: true, stencil: true });  // for clouds; else what there is
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, ...(context && { context }) });
    this.renderer.setPixelRatio(window.devicePixelRatio);
    element.append(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.surfaces = new Map();
    this.paths = new Map();
    this.settings = { field: "", axis: 2, layer: 0, range: null, asCloud: false, solids: true, water: true, paths: true, box: true };
    this.latest = 0;  // number of the last call of show
    this.run = run;
    this.number = -1;
    this.size = [0, 1, 2].map((axis) => (run.domain[1][axis] ?? 0) - (run.domain[0][axis] ?? 0));
    this.addLights();
    this.addBox();
    this.addSlice();
    this.cloud = run.dimension === 3 && context ? new Cloud(this.scene, Math.max(...this.size)) : null;
    this.addCamera();
    new ResizeObserver(() => this.resize()).observe(element);
  }

  addLights() {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8f98, 0.62));
    this.lamp = new THREE.DirectionalLight(0xffffff, 0.6);
    this.scene.add(this.lamp, this.lamp.target);
  }

  addBox() {
    const box = new THREE.BoxGeometry(...this.size.map((length) => length || 1e-9));
    this.box = new THREE.LineSegments(new THREE.EdgesGeometry(box), new THREE.LineBasicMaterial({ color: 0x8b95a1 }));
    this.box.position.set(...this.centre());
    this.scene.add(this.box);
  }

  addSlice() {
    this.slice = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, alphaTest: 0.5, visible: false }));
    this.slice.position.z = this.run.dimension === 2 ? -1e-3 : 0;
    this.scene.add(this.slice);
  }

  addCamera() {
    const isFlat = this.run.dimension === 2;
    this.camera = isFlat ? new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 10) : new THREE.PerspectiveCamera(32, 1, 0.01, 1000);
    this.camera.up.set(0, 0, 0).setComponent(isFlat ? 1 : this.run.view.up, 1);
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.enableRotate = !isFlat;
    this.controls.screenSpacePanning = true;
    if (isFlat) this.controls.mouseButtons.LEFT = THREE.MOUSE.PAN;
    this.controls.addEventListener("change", () => { this.draw(); this.onTurned?.(); });
  }

  centre() { return [0, 1, 2].map((axis) => ((this.run.domain[0][axis] ?? 0) + (this.run.domain[1][axis] ?? 0)) / 2); }

  /// The camera as at first: all of the domain in the picture.
  home() {
    const centre = new THREE.Vector3(...(this.run.view.centre ?? this.centre()));
    this.controls.target.copy(centre);
    const aspect = this.element.clientWidth / Math.max(this.element.clientHeight, 1);
    if (this.run.dimension === 2) {
      const half = 0.54 * Math.max(this.size[1], this.size[0] / aspect);
      Object.assign(this.camera, { left: -half * aspect, right: half * aspect, top: half, bottom: -half, zoom: 1 });
      this.camera.position.copy(centre).add(new THREE.Vector3(0, 0, 5));
    } else {
      this.camera.aspect = aspect;
      this.camera.position.copy(centre).add(this.firstView(aspect));
      const length = Math.max(...this.size);
      Object.assign(this.camera, { near: 0.01 * length, far: 100 * length });
    }
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  /// From the centre to the eye, so far that every corner of the domain is in the picture.
  firstView(aspect) {
    const back = new THREE.Vector3(...this.run.view.direction).normalize();
    const right = new THREE.Vector3().crossVectors(this.camera.up, back).normalize();
    const above = new THREE.Vector3().crossVectors(back, right);
    const slope = Math.tan((this.camera.fov * Math.PI) / 360);
    let distance = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const p = new THREE.Vector3(...this.size.map((length, axis) => ((corner >> axis) & 1 ? 0.5 : -0.5) * length));
      distance = Math.max(distance, p.dot(back) + Math.abs(p.dot(above)) / slope, p.dot(back) + Math.abs(p.dot(right)) / (slope * aspect));
    }
    return back.multiplyScalar((1.04 * distance) / this.run.view.zoom);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.home();
  }

  /// The last frame that is not later, or the first.
  numberAt(time) {
    const { frames } = this.run;
    let number = 0;
    while (number + 1 < frames.length && frames[number + 1].time <= time * (1 + 1e-9) + 1e-12) ++number;
    return number;
  }

  /// Shows the frame of a time; of calls that overlap the last one counts.
  async show(time) {
    const call = ++this.latest;
    const number = this.numberAt(time), frame = this.run.frames[number];
    if (!frame) return;
    const changes = await Promise.all([...frame.surfaces.map((surface) => this.surfaceOf(surface).load(surface)), this.loadSlice(frame), this.loadCloud(frame)]);
    if (call !== this.latest) return;
    for (const change of changes) change();
    this.number = number;
    const there = new Set(frame.surfaces.map(({ name }) => name));
    for (const [name, surface] of this.surfaces) surface.visible = there.has(name) && (surface.isWater ? this.settings.water : this.settings.solids);
    this.box.visible = this.settings.box;
    for (const path of this.paths.values()) {
      path.line.visible = this.settings.paths;
      path.line.geometry.setDrawRange(0, path.times.findLastIndex((t) => t <= frame.time * (1 + 1e-6)) + 1);
    }
    this.draw();
  }

  surfaceOf({ name, water }) {
    if (!this.surfaces.has(name)) {
      const lineWidth = 0.004 * Math.max(...this.size);
      this.surfaces.set(name, new Surface(this.scene, this.colourOf(name, water), water, this.run.dimension, lineWidth));
    }
    return this.surfaces.get(name);
  }

  colourOf(name, isWater) {
    const solids = this.run.frames[0].surfaces.filter(({ water }) => !water).map((surface) => surface.name);
    return isWater ? WATER_COLOUR : SOLID_COLOURS[Math.max(solids.indexOf(name), 0) % SOLID_COLOURS.length];
  }

  async loadSlice(frame) {
    const { field: name, axis, layer, range, asCloud } = this.settings, field = frame.fields[name];
    if (!field || asCloud) return () => { this.slice.material.visible = false; };
    const across = this.run.dimension === 2 ? 2 : axis, number = this.run.dimension === 2 ? 0 : layer;
    const values = await layerOf(field, frame.box.cells, across, number);
    const table = colourTable(field, range), colours = new Uint8Array(4 * values.length);
    values.forEach((value, i) => colours.set(table.subarray(4 * value, 4 * value + 4), 4 * i));
    const [width, height] = frame.box.cells.filter((_, other) => other !== across);
    return () => {
      this.slice.material.map?.dispose();
      this.slice.material.map = new THREE.DataTexture(colours, width, height, THREE.RGBAFormat);
      this.slice.material.map.needsUpdate = true;
      this.slice.material.needsUpdate = true;
      this.slice.material.visible = true;
      this.slice.geometry.dispose();
      this.slice.geometry = layerRectangle(frame.box, across, number);
    };
  }

  async loadCloud(frame) {
    if (!this.cloud) return () => {};
    const { field: name, range, asCloud } = this.settings, field = frame.fields[name], volume = volumeOf(field, frame.box);
    if (!asCloud || !volume) return () => { this.cloud.mesh.visible = false; };
    const bytes = new Uint8Array(await bytesOf(volume.blob));
    return () => {
      this.cloud.set(name, bytes, volume.cells, frame.box.origin, volume.spacing, field, range);
      this.cloud.mesh.visible = true;
    };
  }

  /// What a cloud is seen through.
  notOpaque() {
    const lines = [...this.paths.values()].map(({ line }) => line);
    const water = [...this.surfaces.values()].filter(({ isWater }) => isWater).flatMap(({ parts }) => parts);
    return [this.box, this.slice, ...lines, ...water];
  }

  /// Where the bodies have been, from bodies.csv.
  async loadPaths() {
    for (const [name, table] of Object.entries(this.run.tables["bodies.csv"]?.named ?? {})) {
      const { time, x, y, z } = await columnsOf(table);
      const places = new Float32Array(3 * time.length);
      for (let i = 0; i < time.length; ++i) places.set([x[i], y[i], z ? z[i] : 2e-3], 3 * i);
      if (this.paths.has(name)) this.scene.remove(this.paths.get(name).line);
      const line = new THREE.Line(bufferGeometry(places), new THREE.LineBasicMaterial({ color: new THREE.Color(this.colourOf(name, false)).multiplyScalar(0.7) }));
      line.frustumCulled = false;
      this.scene.add(line);
      this.paths.set(name, { line, times: time });
    }
  }

  draw() {
    // The light comes from above the viewer's left shoulder.
    const { camera, lamp } = this;
    lamp.position.copy(camera.position).add(new THREE.Vector3(-0.5, 0.8, 0).applyQuaternion(camera.quaternion).multiplyScalar(camera.position.distanceTo(this.controls.target)));
    lamp.target.position.copy(this.controls.target);
    if (this.cloud?.mesh.visible) this.cloud.prepare(this.renderer, camera, this.notOpaque());
    this.renderer.render(this.scene, camera);
  }
}
