// The view of one run: spheres, links, cracks and walls in space, tetrahedra and joints in space, triangles and joints in a plane.

import * as THREE from "three";
import {OrbitControls} from "three/examples/jsm/controls/OrbitControls.js";
import {MAPS, palette, ramp, CATEGORIES} from "./colors.js";
import * as shaders from "./shaders.js";

const ACROSS = 2048;

function floatTexture(data, channels, count) {
  const rows = Math.max(1, Math.ceil(count / ACROSS));
  const all = new Float32Array(ACROSS * rows * channels);
  all.set(data.subarray(0, Math.min(data.length, all.length)));
  const texture = new THREE.DataTexture(
    all, ACROSS, rows, channels === 4 ? THREE.RGBAFormat : THREE.RGFormat, THREE.FloatType);
  texture.needsUpdate = true;
  return texture;
}

function colorTexture(bytes, smooth) {
  const texture = new THREE.DataTexture(bytes, bytes.length / 4, 1);
  texture.magFilter = texture.minFilter = smooth ? THREE.LinearFilter : THREE.NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** `count` vertices without attributes: shaders read all from textures. */
function vertices(count) {
  const geometry = new THREE.BufferGeometry();
  geometry.setDrawRange(0, count);
  return geometry;
}

const OF_SQUARE = 6, OF_DISC = 18, OF_SOLID = 12, OF_JOINT = 21;

/** The box of what is worth seeing: the first frame, and of the last all but what flew far. */
function bulk(film, first, last) {
  const axes = film.meta.plane ? 2 : 3, low = [0, 0, 0], high = [0, 0, 0];
  for (let axis = 0; axis < axes; ++axis) {
    const column = (frame) => {
      const values = new Float32Array(film.points);
      for (let i = 0; i < values.length; ++i) values[i] = frame.position[4 * i + axis];
      return values.sort();
    };
    const a = column(first), b = column(last), n = a.length, r = film.spheres ? film.meta.size : 0;
    const cut = Math.floor(0.005 * n);
    low[axis] = Math.min(a[0], Math.max(b[cut], a[0] - 0.3 * (a[n - 1] - a[0]))) - r;
    high[axis] = Math.max(a[n - 1], Math.min(b[n - 1 - cut], a[n - 1] + 0.3 * (a[n - 1] - a[0]))) + r;
  }
  return {low: new THREE.Vector3(...low), high: new THREE.Vector3(...high)};
}

export class Viewer {
  /** @param run  the run's part of the page's data */
  constructor(host, run, film) {
    this.host = host;
    this.run = run;
    this.film = film;
    this.plane = film.meta.plane;
    this.bodies = film.meta.solid;
    this.renderer = new THREE.WebGLRenderer({antialias: true, alpha: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    host.append(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -10, 10);
    this.camera.up.set(0, this.plane ? 1 : 0, this.plane ? 0 : 1);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.enableDamping = false;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", () => {
      this.redraw();
      this.turned?.(this);
    });
    if (this.plane) {
      this.controls.enableRotate = false;
      this.controls.mouseButtons.LEFT = THREE.MOUSE.PAN;
      this.controls.touches.ONE = THREE.TOUCH.PAN;
    }
    this.clip = null; // {axis, sign, at}
    this.uniforms = {
      uNow: {value: null}, uFirst: {value: null}, uValue: {value: null}, uAcross: {value: ACROSS},
      uScale: {value: 1}, uMap: {value: null}, uRange: {value: new THREE.Vector2(0, 1)}, uCategories: {value: 0},
      uBody: {value: new Array(16).fill(1)}, uClip: {value: new THREE.Vector4(0, 0, 0, 1e30)},
      uLinesAcross: {value: ACROSS}, uMesh: {value: 1}, uPixel: {value: 1}, uWithin: {value: 0},
    };
    this.maps = {};
    for (const name of Object.keys(MAPS)) this.maps[name] = colorTexture(ramp(name), true);
    this.categories = colorTexture(palette(), false);
    this.resizing = new ResizeObserver(() => this.resize());
    this.resizing.observe(host);
  }

  async start() {
    const {film} = this;
    const first = await film.frame(0);
    const last = await film.frame(film.times.length - 1);
    this.box = bulk(film, first, last);
    this.uniforms.uFirst.value = floatTexture(first.position, 4, film.points);
    if (this.plane) this.buildPlane();
    else if (this.bodies) this.buildBodies();
    else this.buildSpace();
    if (film.meta.contact_force) this.buildContacts();
    if (film.meta.bolt_force != null) this.buildBolts();
    this.buildSurroundings();
    this.look(this.plane ? "z" : /^(iso|x|y|z)$/.test(this.run.view) ? this.run.view : "iso");
    this.resize();
  }

  material(pair, extra = {}, options = {}) {
    return new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: pair.vertex, fragmentShader: pair.fragment,
      uniforms: {...this.uniforms, ...Object.fromEntries(Object.entries(extra).map(([k, v]) => [k, {value: v}]))},
      ...options,
    });
  }

  add(geometry, material, order = 0) {
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    mesh.renderOrder = order;
    this.scene.add(mesh);
    return mesh;
  }

  buildSpace() {
    const {film, run} = this, spheres = () => vertices(OF_SQUARE * film.meta.elements);
    const size = film.meta.size;
    this.solid = this.add(spheres(), this.material(shaders.spheres, {uWanted: 1, uThrough: 0}));
    this.through = this.add(spheres(),
      this.material(shaders.spheres, {uWanted: 2, uThrough: 1}, {transparent: true, depthWrite: false}), 5);
    const two = {side: THREE.DoubleSide};
    const links = (style, width) => this.add(vertices(0),
      this.material(shaders.links, {uStyle: style, uWidth: width, uLines: null}, two), 1);
    this.bars = links(0, Math.max(run.bar_radius || 0, 0.25 * size));
    this.links = links(1, 0.16 * size);
    this.forces = links(2, 0.45 * size);
    this.cracks = this.add(vertices(0), this.material(shaders.cracks, {uLines: null}, two), 2);
    for (const mesh of [this.bars, this.links, this.forces, this.cracks]) mesh.visible = false;
  }

  buildPlane() {
    const corners = () => vertices(3 * this.film.meta.elements);
    const options = {side: THREE.DoubleSide, depthTest: false};
    this.solid = this.add(corners(), this.material(shaders.triangles, {uWanted: 1, uThrough: 0}, options));
    this.through = this.add(corners(),
      this.material(shaders.triangles, {uWanted: 2, uThrough: 1}, {...options, transparent: true}), 1);
    this.cracks = this.add(vertices(0), this.material(shaders.joints, {uLines: null, uEnds: null}, {...options, transparent: true}), 2);
  }

  /** Tetrahedra: faces, flat sections of a cut, and joints that have softened or broken. */
  buildBodies() {
    const {elements} = this.film.meta, two = {side: THREE.DoubleSide}, veil = {transparent: true, depthWrite: false};
    const faces = () => vertices(OF_SOLID * elements), sections = () => vertices(OF_SQUARE * elements);
    this.solid = this.add(faces(), this.material(shaders.faces, {uWanted: 1, uThrough: 0}));
    this.through = this.add(faces(), this.material(shaders.faces, {uWanted: 2, uThrough: 1}, veil), 5);
    this.sections = this.add(sections(), this.material(shaders.sections, {uWanted: 1, uThrough: 0}, two));
    this.cracks = this.add(vertices(0), this.material(shaders.faceJoints, {uLines: null, uEnds: null}, {...two, transparent: true}), 2);
  }

  /** What presses without a link, over all else. */
  buildContacts() {
    const width = (this.film.spheres ? 0.35 : 0.12) * this.film.meta.size;
    this.contacts = this.add(vertices(0), this.material(shaders.contacts, {uEnds: null, uWidth: width},
      {side: THREE.DoubleSide, transparent: true, depthTest: false, depthWrite: false}), 7);
    this.contacts.visible = false;
  }

  fillContacts() {
    const ends = this.pressing;
    if (!this.contacts?.visible || !ends) return;
    const {uEnds} = this.contacts.material.uniforms;
    uEnds.value?.dispose();
    // The strongest come first in the film, and are to lie on top.
    const count = ends.length / 8, upwards = new Float32Array(ends.length);
    for (let i = 0; i < count; ++i) upwards.set(ends.subarray(8 * i, 8 * i + 8), 8 * (count - 1 - i));
    uEnds.value = floatTexture(upwards, 4, 2 * count);
    this.contacts.geometry.setDrawRange(0, OF_SQUARE * count);
  }

  /** Bolts, over the rock that they are in. */
  buildBolts() {
    this.bolts = this.add(vertices(0), this.material(shaders.bolts, {uEnds: null},
      {side: THREE.DoubleSide, transparent: true, depthTest: false, depthWrite: false}), 8);
  }

  fillBolts() {
    if (!this.bolts || !this.tied) return;
    const {uEnds} = this.bolts.material.uniforms;
    uEnds.value?.dispose();
    const count = this.tied.length / 8;
    uEnds.value = floatTexture(this.tied, 4, Math.max(2 * count, 1));
    this.bolts.geometry.setDrawRange(0, OF_SQUARE * count);
  }

  /** Walls, and regions that are held or loaded. */
  buildSurroundings() {
    const {low, high} = this.box, middle = low.clone().add(high).multiplyScalar(0.5);
    const reach = high.clone().sub(low).length();
    this.surroundings = new THREE.Group();
    this.walls = this.plane ? [] : (this.run.walls || []).map((wall) => {
      const normal = new THREE.Vector3(...wall.normal).normalize(), point = new THREE.Vector3(...wall.point);
      const at = middle.clone().addScaledVector(normal, normal.dot(point.clone().sub(middle)));
      const patch = new THREE.Mesh(new THREE.PlaneGeometry(1.1 * reach, 1.1 * reach),
        new THREE.MeshBasicMaterial({color: "#7d8ea3", transparent: true, opacity: 0.16, side: THREE.DoubleSide, depthWrite: false}));
      patch.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
      patch.add(new THREE.LineSegments(new THREE.EdgesGeometry(patch.geometry), new THREE.LineBasicMaterial({color: "#7d8ea3"})));
      patch.renderOrder = 6;
      this.surroundings.add(patch);
      return {patch, at, velocity: new THREE.Vector3(...wall.velocity)};
    });
    this.regions = new THREE.Group();
    const corner = (bound, axis, side, grow) => {
      const limit = (side < 0 ? low : high).getComponent(axis) + side * grow;
      const given = bound?.[axis];
      return given == null || !Number.isFinite(given) ? limit : side < 0 ? Math.max(given, limit) : Math.min(given, limit);
    };
    for (const region of this.run.regions || []) {
      const grow = 0.01 * reach, a = [0, 0, 0], b = [0, 0, 0];
      for (let axis = 0; axis < (this.plane ? 2 : 3); ++axis) {
        a[axis] = corner(region.low, axis, -1, grow);
        b[axis] = corner(region.high, axis, 1, grow);
      }
      if (a.some((v, axis) => v > b[axis])) continue;
      const box = new THREE.BoxGeometry(...b.map((v, axis) => Math.max(v - a[axis], 1e-9)));
      const lines = new THREE.LineSegments(new THREE.EdgesGeometry(box), new THREE.LineBasicMaterial({color: region.load ? "#d55e00" : "#3569b8"}));
      lines.position.set(...a.map((v, axis) => 0.5 * (v + b[axis])));
      this.regions.add(lines);
    }
    this.scene.add(this.surroundings, this.regions);
    this.regions.visible = false;
  }

  /** Directions of the camera: the words of `breccia render --view`. */
  look(view) {
    const {low, high} = this.box, middle = low.clone().add(high).multiplyScalar(0.5);
    const reach = high.clone().sub(low).length();
    const direction = this.plane ? [0, 0, 1] : {iso: [1, -1.2, 0.8], x: [1, 0, 0], y: [0, -1, 0], z: [0, -1e-3, 1]}[view];
    this.reach = reach;
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).addScaledVector(new THREE.Vector3(...direction).normalize(), 2 * reach);
    this.camera.near = -20 * reach;
    this.camera.far = 40 * reach;
    this.camera.zoom = 1;
    this.camera.lookAt(middle);
    this.controls.update();
    this.fit();
    this.redraw();
  }

  /** The frame of the camera around the box, as it is seen from here. */
  fit() {
    const {low, high} = this.box;
    this.camera.updateMatrixWorld();
    const inverse = this.camera.matrixWorld.clone().invert();
    let right = 0, up = 0;
    const target = this.controls.target.clone().applyMatrix4(inverse);
    for (let k = 0; k < 8; ++k) {
      const p = new THREE.Vector3(k & 1 ? low.x : high.x, k & 2 ? low.y : high.y, k & 4 ? low.z : high.z).applyMatrix4(inverse).sub(target);
      right = Math.max(right, Math.abs(p.x));
      up = Math.max(up, Math.abs(p.y));
    }
    this.half = {right: 1.08 * right, up: 1.12 * up};
    this.frameCamera();
  }

  frameCamera() {
    if (!this.half) return;
    const width = Math.max(this.host.clientWidth, 1), height = Math.max(this.host.clientHeight, 1);
    const up = Math.max(this.half.up, (this.half.right * height) / width, 1e-9);
    this.camera.top = up;
    this.camera.bottom = -up;
    this.camera.right = (up * width) / height;
    this.camera.left = -this.camera.right;
    this.camera.updateProjectionMatrix();
    this.redraw();
  }

  resize() {
    const width = Math.max(this.host.clientWidth, 1), height = Math.max(this.host.clientHeight, 1);
    this.renderer.setSize(width, height, false);
    this.frameCamera();
  }

  /** Shows a frame. @param values  one number an element */
  show(frame, values) {
    const {film, uniforms} = this;
    const old = [uniforms.uNow, uniforms.uValue].map((u) => u.value);
    uniforms.uNow.value = floatTexture(frame.position, 4, film.points);
    const pairs = new Float32Array(2 * film.meta.elements), {group, exposed} = frame.fields;
    for (let i = 0; i < film.meta.elements; ++i) {
      pairs[2 * i] = values ? values[i] : 0;
      // Of tetrahedra the faces that can be seen as well.
      pairs[2 * i + 1] = (group ? group[i] : 0) + (this.bodies ? 65536 * (exposed ? exposed[i] : 15) : 0);
    }
    uniforms.uValue.value = floatTexture(pairs, 2, film.meta.elements);
    this.lines = frame.lines;
    this.pressing = frame.contacts;
    this.tied = frame.bolts;
    this.fillLines();
    for (const {patch, at, velocity} of this.walls) patch.position.copy(at).addScaledVector(velocity, frame.time);
    for (const texture of old) texture?.dispose();
    this.redraw();
  }

  /** Gives each list of lines that is shown the lines that belong to it. */
  fillLines() {
    if (!this.lines) return;
    this.fillContacts();
    this.fillBolts();
    if (this.plane || this.bodies) return this.fillJoints();
    const {kind = [], state = [], force = []} = this.lines.fields;
    const largest = this.film.meta.fields.find((f) => f.lines && f.name === "force")?.high || 1;
    const share = (l) => Math.min(1, (4 * (force[l] ?? 0)) / largest);
    this.fill(this.bars, OF_SQUARE, (l) => kind[l] === 1 && state[l] !== 2, share);
    this.fill(this.links, OF_SQUARE, (l) => state[l] !== 2, share);
    this.fill(this.forces, OF_SQUARE, (l) => state[l] !== 2 && share(l) > 0.12, share);
    this.fill(this.cracks, OF_DISC, (l) => state[l] === 2, share);
  }

  fill(mesh, each, takes, share) {
    if (!mesh.visible) return;
    const {count, ends, fields: {kind = [], state = []}} = this.lines, data = [];
    for (let l = 0; l < count; ++l)
      if (takes(l)) data.push(ends[2 * l], ends[2 * l + 1], 8 * (kind[l] ?? 0) + (state[l] ?? 0), share(l));
    const {uLines} = mesh.material.uniforms;
    uLines.value?.dispose();
    uLines.value = floatTexture(new Float32Array(data), 4, data.length / 4);
    mesh.geometry.setDrawRange(0, (each * data.length) / 4);
  }

  fillJoints() {
    const {count, ends, fields: {damage, mode}} = this.lines, data = new Float32Array(4 * count);
    for (let l = 0; l < count; ++l) {
      data[4 * l] = damage ? damage[l] : 1;
      data[4 * l + 1] = mode ? mode[l] : 0;
    }
    const {uLines, uEnds} = this.cracks.material.uniforms;
    uLines.value?.dispose();
    uEnds.value?.dispose();
    uLines.value = floatTexture(data, 4, count);
    uEnds.value = floatTexture(ends, 4, (this.bodies ? 3 : 1) * count);
    this.cracks.geometry.setDrawRange(0, (this.bodies ? OF_JOINT : OF_SQUARE) * count);
  }

  color({category, map, low, high}) {
    this.uniforms.uMap.value = category ? this.categories : this.maps[map];
    this.uniforms.uCategories.value = category ? CATEGORIES.length : 0;
    this.uniforms.uRange.value.set(low, high);
    this.redraw();
  }

  /** The same camera as another view's. */
  follow(other) {
    this.camera.position.copy(other.camera.position);
    this.camera.quaternion.copy(other.camera.quaternion);
    this.camera.zoom = other.camera.zoom;
    this.controls.target.copy(other.controls.target);
    this.half = other.half;
    this.frameCamera();
  }

  /** As cameraState() of another page of this run gave it. */
  setCamera({position, target, zoom}) {
    this.camera.position.fromArray(position);
    this.controls.target.fromArray(target);
    this.camera.zoom = zoom;
    this.controls.update();
    this.frameCamera();
  }

  cameraState() {
    return {position: this.camera.position.toArray(), target: this.controls.target.toArray(), zoom: this.camera.zoom};
  }

  /** Eye, target and angle of a parallel view, the picture as high as the angle takes in at the target, and what a cut leaves. */
  cameraText() {
    const eye = this.camera.position, target = this.controls.target, up = this.camera.up;
    const angle = 2 * Math.atan(this.camera.top / this.camera.zoom / eye.distanceTo(target));
    const list = (v) => `[${v.toArray().map((x) => Number(x.toPrecision(6))).join(", ")}]`;
    const {axis, sign, at} = this.clip ?? {};
    const cut = this.clip ? `clip = "${"xyz"[axis]}${sign < 0 ? ">" : "<"}${Number(at.toFixed(9))}"\n` : "";
    return `[[key]]\neye = ${list(eye)}\ntarget = ${list(target)}\nup = ${list(up)}\nangle = "${Number(((angle * 180) / Math.PI).toPrecision(6))} deg"\n${cut}`;
  }

  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.draw();
    });
  }

  draw() {
    if (!this.uniforms.uNow.value) return;
    this.camera.updateMatrixWorld();
    const clip = this.uniforms.uClip.value;
    if (this.clip) {
      const {axis, sign, at} = this.clip;
      const normal = new THREE.Vector3().setComponent(axis, sign);
      const point = new THREE.Vector3().setComponent(axis, at);
      const inverse = this.camera.matrixWorldInverse;
      point.applyMatrix4(inverse);
      normal.transformDirection(inverse);
      clip.set(normal.x, normal.y, normal.z, normal.dot(point));
    } else {
      clip.set(0, 0, 0, 1e30);
    }
    this.uniforms.uPixel.value = (2 * this.camera.top) / this.camera.zoom / Math.max(this.host.clientHeight, 1);
    this.through.visible = this.uniforms.uBody.value.includes(2);
    this.uniforms.uWithin.value = this.uniforms.uScale.value !== 1 || this.uniforms.uBody.value.some((b) => b !== 1) ? 1 : 0;
    if (this.sections) this.sections.visible = Boolean(this.clip);
    this.renderer.render(this.scene, this.camera);
    this.drawn?.(this);
  }

  /** Metres a pixel, for the bar of scale. */
  get metresPerPixel() {
    return this.uniforms.uPixel.value;
  }
}
