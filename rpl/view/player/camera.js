"use strict";
// The camera: around a target, z up; turned, shifted and brought nearer by pointers and the wheel.

const TURN = Math.PI / 180, SIGHT = 30 * TURN;
// Where the eye is, seen from the target: azimuth about z from +x, and elevation.
const VIEWS = { isometric: [-55, 26], front: [-90, 0], side: [0, 0], top: [-90, 89.9] };

class Camera {
  constructor(bounds, aspect) {
    this.bounds = bounds;
    this.aspect = aspect;
    this.view("isometric");
  }
  view(name) {
    const [low, high] = this.bounds;
    this.target = low.map((value, k) => (value + high[k]) / 2);
    this.radius = Math.max(Math.hypot(...low.map((value, k) => high[k] - value)) / 2, 100);
    [this.azimuth, this.elevation] = VIEWS[name].map((angle) => angle * TURN);
    // So far away that the corners of the bounds just fit.
    const axes = this.axes(), half = low.map((value, k) => (high[k] - value) / 2), room = Math.tan(SIGHT / 2) / Math.min(this.aspect, 1);
    this.distance = 100;
    for (let n = 0; n < 8; n++) {
      const corner = half.map((value, k) => (n & (1 << k) ? value : -value)), [x, y, z] = axes.map((axis) => axis[0] * corner[0] + axis[1] * corner[1] + axis[2] * corner[2]);
      this.distance = Math.max(this.distance, 1.08 * (z + Math.max(Math.abs(x) / (room * this.aspect), Math.abs(y) / room)));
    }
  }
  back() {
    const c = Math.cos(this.elevation);
    return [c * Math.cos(this.azimuth), c * Math.sin(this.azimuth), Math.sin(this.elevation)];
  }
  axes() {
    const z = this.back(), x = [-Math.sin(this.azimuth), Math.cos(this.azimuth), 0];
    return [x, [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]], z];
  }
  eye() { return this.back().map((value, k) => this.target[k] + value * this.distance); }
  near() { return this.distance / 100; }
  matrix(aspect) {
    const [x, y, z] = this.axes(), eye = this.eye(), near = this.near(), far = this.distance * 4 + this.radius * 8;
    const f = 1 / Math.tan(SIGHT / 2), narrow = Math.min(aspect, 1), dot = (a) => a[0] * eye[0] + a[1] * eye[1] + a[2] * eye[2];
    const sx = (f / aspect) * narrow, sy = f * narrow, a = (far + near) / (near - far), b = (2 * far * near) / (near - far);
    const found = [];
    for (let k = 0; k < 3; k++) found.push(sx * x[k], sy * y[k], a * z[k], -z[k]);
    return found.concat([-sx * dot(x), -sy * dot(y), -a * dot(z) + b, dot(z)]);
  }
  // Where on the screen a point of the cell is, in points from the corner above left; null behind the camera.
  seen(point, width, height) {
    const m = this.matrix(width / height), v = [0, 1, 2, 3].map((r) => m[r] * point[0] + m[4 + r] * point[1] + m[8 + r] * point[2] + m[12 + r]);
    return v[3] > this.near() ? [((v[0] / v[3] + 1) * width) / 2, ((1 - v[1] / v[3]) * height) / 2] : null;
  }
  // The direction in which a point of the screen looks.
  ray(x, y, width, height) {
    const [right, up, back] = this.axes(), aspect = width / height, t = Math.tan(SIGHT / 2) / Math.min(aspect, 1);
    const u = ((2 * x) / width - 1) * t * aspect, v = (1 - (2 * y) / height) * t;
    const way = right.map((value, k) => value * u + up[k] * v - back[k]), size = Math.hypot(...way);
    return way.map((value) => value / size);
  }
  turn(dx, dy) {
    this.azimuth -= dx * 0.008;
    this.elevation = Math.min(Math.max(this.elevation + dy * 0.008, -89.9 * TURN), 89.9 * TURN);
  }
  shift(dx, dy, height) {
    const [x, y] = this.axes(), scale = (2 * this.distance * Math.tan(SIGHT / 2)) / height;
    this.target = this.target.map((value, k) => value - x[k] * dx * scale + y[k] * dy * scale);
  }
  zoom(factor) { this.distance = Math.min(Math.max(this.distance * factor, this.radius / 50), this.radius * 40); }
  // Drag turns; with shift or another button it shifts; two fingers shift and zoom. `moved` is called after each change.
  listen(canvas, moved) {
    const pointers = new Map();
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); pointers.set(event.pointerId, [event.clientX, event.clientY]); });
    ["pointerup", "pointercancel"].forEach((name) => canvas.addEventListener(name, (event) => pointers.delete(event.pointerId)));
    canvas.addEventListener("pointermove", (event) => {
      const old = pointers.get(event.pointerId);
      if (!old) return;
      const here = [event.clientX, event.clientY], dx = here[0] - old[0], dy = here[1] - old[1];
      if (pointers.size === 2) {
        const [other] = [...pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place), far = (p) => Math.max(Math.hypot(p[0] - other[0], p[1] - other[1]), 1);
        this.zoom(far(old) / far(here));
        this.shift(dx / 2, dy / 2, canvas.clientHeight);
      } else if (event.buttons & 6 || event.shiftKey) this.shift(dx, dy, canvas.clientHeight);
      else this.turn(dx, dy);
      pointers.set(event.pointerId, here);
      moved();
    });
    canvas.addEventListener("wheel", (event) => { event.preventDefault(); this.zoom(Math.exp(Math.min(Math.max(event.deltaY, -120), 120) * 0.0015)); moved(); }, { passive: false });
  }
}
