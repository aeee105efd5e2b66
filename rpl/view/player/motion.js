"use strict";
// Where everything is at a time. A pose is twelve numbers, the upper rows of its matrix; lengths are mm, angles rad.

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

// Numbers of the document: multiples of a step.
function unpacked(packing) {
  const bytes = Uint8Array.from(atob(packing.data), (sign) => sign.charCodeAt(0));
  const whole = new { i1: Int8Array, i2: Int16Array, i4: Int32Array }[packing.type](bytes.buffer);
  return Float64Array.from(whole, (value) => value * packing.step);
}

// The last place in a sorted list whose `key` is at most `value`; -1 before the first.
function lastAt(list, value, key) {
  let low = 0, high = list.length;
  while (low < high) { const middle = (low + high) >> 1; if ((key ? key(list[middle]) : list[middle]) <= value) low = middle + 1; else high = middle; }
  return low - 1;
}
const MOMENT = 1e-6, since = (row) => row[0];

class Arm {
  constructor(robot) {
    this.base = robot.base;
    this.screws = robot.screws;
    this.count = robot.joints.length;
    this.t = unpacked(robot.t);
    this.q = unpacked(robot.q);
    this.path = unpacked(robot.tool);
    this.speed = unpacked(robot.speed);
    this.tools = robot.tools;
  }
  joints(time) {
    const { t, q, count } = this, found = new Array(count);
    const before = Math.max(lastAt(t, time), 0), after = Math.min(before + 1, t.length - 1), gap = t[after] - t[before];
    const share = gap > 0 ? Math.min(Math.max((time - t[before]) / gap, 0), 1) : 0;
    for (let n = 0; n < count; n++) found[n] = q[before * count + n] + share * (q[after * count + n] - q[before * count + n]);
    return found;
  }
  speedAt(time) { return this.speed[Math.max(lastAt(this.t, time), 0)]; }
  // How far each link is from its place with all variables zero, the base first; in the cell.
  links(joints) {
    const { points, directions, sliding, matrix, offsets } = this.screws, found = [this.base];
    for (let n = 0; n < this.count; n++) {
      let amount = -offsets[n];
      for (let k = 0; k < this.count; k++) amount += matrix[n][k] * joints[k];
      found.push(Pose.times(found[n], sliding[n] ? Pose.slid(directions[n], amount) : Pose.turned(directions[n], points[n], amount)));
    }
    return found;
  }
  tool(time) {
    if (!this.tools.length) return Pose.one();
    return this.tools[Math.max(lastAt(this.tools, time + MOMENT, since), 0)][1];
  }
}

class Motion {
  constructor(run) {
    this.run = run;
    this.arms = run.robots.map((robot) => (robot.screws ? new Arm(robot) : null));
  }
  at(time) {
    const { run } = this;
    const joints = this.arms.map((arm) => arm && arm.joints(time));
    const links = this.arms.map((arm, n) => arm && arm.links(joints[n]));
    const flanges = this.arms.map((arm, n) => arm && Pose.times(links[n][arm.count], arm.screws.flange));
    const tools = this.arms.map((arm, n) => arm && Pose.times(flanges[n], arm.tool(time)));
    const parts = run.parts.map((places) => this.part(places, time, flanges));
    const bodies = run.bodies.map((body) => {
      if (body.part !== undefined) return Pose.times(parts[body.part], body.at);
      if (body.robot === undefined || !links[body.robot]) return body.at;
      return Pose.times(links[body.robot][body.link], this.opened(body, time));
    });
    return { time, joints, flanges, tools, bodies, parts };
  }
  opened(body, time) {
    if (body.gripper === undefined) return body.at;
    const widths = this.run.grippers[body.gripper].widths, way = (body.side * widths[Math.max(lastAt(widths, time + MOMENT, since), 0)][1]) / 2;
    return Pose.moved(body.at, [1, 5, 9].map((i) => body.at[i] * way));
  }
  part(places, time, flanges) {
    const n = Math.max(lastAt(places, time, since), 0), [t, state, robot, pose] = places[n], after = places[n + 1];
    if (state === "held" && flanges[robot]) return Pose.times(flanges[robot], pose);
    if (state !== "falls" || !after || after[0] <= t) return pose;
    const share = (time - t) / (after[0] - t);
    return Pose.moved(pose, [3, 7, 11].map((i) => share * (after[3][i] - pose[i])));
  }
}
