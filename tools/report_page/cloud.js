"use strict";
// A field of three dimensions as a cloud: every pixel adds up what lies on its ray, in front of what is opaque.

const CLOUDY = ["smoke", "temperature"];  // what else would be a cloud only if its scene says so
const SMOKE = [138, 142, 150];
const OPTICAL_DEPTH = 22;                 // of the largest density across the longest edge of the domain
const LIGHT_FROM = new THREE.Vector3(-0.4, 0.75, 0.55).normalize();  // in the viewer's axes

const CLOUD_VERTICES = `
varying vec3 place;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  place = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

// alpha = 1 - exp(-(integral of extinction * density along the ray)); light is dimmed on its way to each point likewise.
const CLOUD_FRAGMENTS = `
#include <packing>
precision highp sampler3D;
uniform sampler3D field;
uniform sampler2D colours, depths;
uniform vec3 low, size, towardsLight;
uniform vec2 scale, clip, pixels;
uniform float extinction, stride, shadowStride;
varying vec3 place;

float density(vec3 p) { return clamp(scale.x * texture(field, (p - low) / size).r + scale.y, 0.0, 1.0); }

float light(vec3 p) {
  float sum = 0.0;
  for (int i = 0; i < 5; ++i) {
    p += shadowStride * towardsLight;
    if (any(lessThan(p, low)) || any(greaterThan(p, low + size))) break;
    sum += density(p);
  }
  return exp(-0.5 * extinction * shadowStride * sum);
}

void main() {
  vec3 along = normalize(place - cameraPosition);
  vec3 one = (low - cameraPosition) / along, other = (low + size - cameraPosition) / along;
  vec3 entries = min(one, other), exits = max(one, other);
  float begin = max(max(max(entries.x, entries.y), entries.z), 0.0), end = min(min(exits.x, exits.y), exits.z);
  float depth = unpackRGBAToDepth(texture2D(depths, gl_FragCoord.xy / pixels));
  end = min(end, perspectiveDepthToViewZ(depth, clip.x, clip.y) / (viewMatrix * vec4(along, 0.0)).z);
  // Steps of equal length; where they begin differs from pixel to pixel, which hides their layers.
  float steps = ceil(max(end - begin, 0.0) / stride), step = (end - begin) / max(steps, 1.0);
  float offset = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  vec3 colour = vec3(0.0);
  float through = 1.0;
  for (int i = 0; i < 256; ++i) {
    if (float(i) >= steps || through < 0.004) break;
    vec3 p = cameraPosition + (begin + (float(i) + offset) * step) * along;
    float d = density(p), passed = exp(-extinction * step * d);
    if (d > 0.003) {
      vec3 lit = texture2D(colours, vec2(d, 0.5)).rgb * mix(0.35, 1.15, light(p));
      colour += through * (1.0 - passed) * lit;
    }
    through *= passed;
  }
  if (through > 0.998) discard;
  gl_FragColor = vec4(colour / (1.0 - through), 1.0 - through);
}`;

/// A row of 256 colours from no density to the largest.
function cloudColours(name) {
  const table = new Uint8Array(4 * 256);
  for (let i = 0; i < 256; ++i) table.set([...(name === "smoke" ? SMOKE : viridis(i / 255)), 255], 4 * i);
  const texture = new THREE.DataTexture(table, 256, 1, THREE.RGBAFormat);
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

class Cloud {
  /// `longest`: the longest edge of the domain [m].
  constructor(scene, longest) {
    this.scene = scene;
    this.longest = longest;
    this.opaque = new THREE.MeshDepthMaterial({ depthPacking: THREE.RGBADepthPacking, side: THREE.DoubleSide });
    this.depths = new THREE.WebGLRenderTarget(1, 1, { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter });
    const uniforms = { field: {}, colours: {}, depths: { value: this.depths.texture }, low: { value: new THREE.Vector3() },
      size: { value: new THREE.Vector3() }, towardsLight: { value: new THREE.Vector3() }, scale: { value: new THREE.Vector2() },
      clip: { value: new THREE.Vector2() }, pixels: { value: new THREE.Vector2() }, extinction: { value: OPTICAL_DEPTH / longest },
      stride: { value: longest / 100 }, shadowStride: { value: 0.03 * longest } };
    this.material = new THREE.ShaderMaterial({ uniforms, vertexShader: CLOUD_VERTICES, fragmentShader: CLOUD_FRAGMENTS,
      side: THREE.BackSide, transparent: true, depthTest: false, depthWrite: false });
    this.mesh = new THREE.Mesh(new THREE.BoxGeometry(1, 1, 1), this.material);
    this.mesh.renderOrder = 5;
    this.mesh.visible = false;
    scene.add(this.mesh);
  }

  /// Bytes of cells of this size from `low` on; a range of colours for all frames.
  set(name, bytes, cells, low, spacing, { low: lowest, high: highest }, range) {
    const { uniforms } = this.material, size = cells.map((n, axis) => n * spacing[axis]);
    uniforms.field.value?.dispose();
    uniforms.field.value = new THREE.DataTexture3D(bytes.map((value) => (value === 255 ? 0 : value)), ...cells);
    Object.assign(uniforms.field.value, { format: THREE.RedFormat, type: THREE.UnsignedByteType, unpackAlignment: 1,
      minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter, needsUpdate: true });
    if (this.name !== name) {
      uniforms.colours.value?.dispose();
      uniforms.colours.value = cloudColours(name);
      this.name = name;
    }
    const span = range.high - range.low;
    uniforms.scale.value.set(((255 / 254) * (highest - lowest)) / span, (lowest - range.low) / span);
    uniforms.low.value.set(...low);
    uniforms.size.value.set(...size);
    this.mesh.scale.set(...size);
    this.mesh.position.set(...low.map((x, axis) => x + size[axis] / 2));
  }

  /// To be called before the picture is drawn: where opaque things end the rays. `others` are not opaque.
  prepare(renderer, camera, others) {
    const { uniforms } = this.material;
    renderer.getDrawingBufferSize(uniforms.pixels.value);
    uniforms.clip.value.set(camera.near, camera.far);
    uniforms.towardsLight.value.copy(LIGHT_FROM).applyQuaternion(camera.quaternion);
    this.depths.setSize(uniforms.pixels.value.x, uniforms.pixels.value.y);
    const hidden = [this.mesh, ...others].filter(({ visible }) => visible);
    for (const object of hidden) object.visible = false;
    this.scene.overrideMaterial = this.opaque;
    renderer.setRenderTarget(this.depths);
    renderer.setClearColor(0xffffff, 1);
    renderer.render(this.scene, camera);
    renderer.setClearColor(0x000000, 0);
    renderer.setRenderTarget(null);
    this.scene.overrideMaterial = null;
    for (const object of hidden) object.visible = true;
  }
}
