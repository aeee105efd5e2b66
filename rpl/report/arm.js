"use strict";
// Poses, and how an arm moves. A pose is twelve numbers, the upper rows of its matrix; lengths are mm, angles rad.

const Pose = {
  one: () => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0],
  times(a, b) {
    const found = new Array(12);
    for (let i = 0; i < 12; i += 4) {
      for (let j = 0; j < 4; j++) found[i + j] = a[i] * b[j] + a[i + 1] * b[4 + j] + a[i + 2] * b[8 + j];
      found[i + 3] += a[i + 3];
    }
    return found;
  },
  point: (a, p) => [0, 4, 8].map((i) => a[i] * p[0] + a[i + 1] * p[1] + a[i + 2] * p[2] + a[i + 3]),
  place: (a) => [a[3], a[7], a[11]],
  inverse(a) {
    const found = [a[0], a[4], a[8], 0, a[1], a[5], a[9], 0, a[2], a[6], a[10], 0];
    for (let i = 0; i < 12; i += 4) found[i + 3] = -(found[i] * a[3] + found[i + 1] * a[7] + found[i + 2] * a[11]);
    return found;
  },
  moved(a, [x, y, z]) { const found = a.slice(); found[3] += x; found[7] += y; found[11] += z; return found; },
  slid: (u, way) => [1, 0, 0, u[0] * way, 0, 1, 0, u[1] * way, 0, 0, 1, u[2] * way],
  // About an axis with direction u through the point p (Rodrigues).
  turned([x, y, z], p, angle) {
    const c = Math.cos(angle), s = Math.sin(angle), d = 1 - c;
    const a = [c + x * x * d, x * y * d - z * s, x * z * d + y * s, 0, x * y * d + z * s, c + y * y * d, y * z * d - x * s, 0, x * z * d - y * s, y * z * d + x * s, c + z * z * d, 0];
    const q = Pose.point(a, p);
    a[3] = p[0] - q[0]; a[7] = p[1] - q[1]; a[11] = p[2] - q[2];
    return a;
  },
};

// How far each link is from its place with all variables zero, the base first (see rpl/report/screws.py).
function armLinks(base, { points, directions, sliding, matrix, offsets }, joints) {
  const found = [base];
  for (let n = 0; n < points.length; n++) {
    let amount = -offsets[n];
    for (let k = 0; k < points.length; k++) amount += matrix[n][k] * joints[k];
    found.push(Pose.times(found[n], sliding[n] ? Pose.slid(directions[n], amount) : Pose.turned(directions[n], points[n], amount)));
  }
  return found;
}
