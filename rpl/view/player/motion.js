"use strict";
// Where everything is at a time.

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
    this.places = robot.places && unpacked(robot.places);
    this.turns = robot.turns && unpacked(robot.turns);
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
  links(joints, time) { return armLinks(this.baseAt(time), this.screws, joints); }
  // Where a track has the base; it turns at samples only.
  baseAt(time) {
    if (!this.places) return this.base;
    const { t, places, turns } = this, n = Math.max(lastAt(t, time), 0), next = Math.min(n + 1, t.length - 1), gap = t[next] - t[n];
    const share = gap > 0 ? Math.min(Math.max((time - t[n]) / gap, 0), 1) : 0, found = [];
    for (let i = 0; i < 3; i++) found.push(turns[9 * n + 3 * i], turns[9 * n + 3 * i + 1], turns[9 * n + 3 * i + 2], places[3 * n + i] + share * (places[3 * next + i] - places[3 * n + i]));
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
    const links = this.arms.map((arm, n) => arm && arm.links(joints[n], time));
    const flanges = this.arms.map((arm, n) => arm && Pose.times(links[n][arm.count], arm.screws.flange));
    const tools = this.arms.map((arm, n) => arm && Pose.times(flanges[n], arm.tool(time)));
    const parts = run.parts.map((places) => this.part(places, time, flanges));
    const bodies = run.bodies.map((body) => {
      if (body.part !== undefined) return parts[body.part];
      if (body.robot === undefined || !links[body.robot]) return body.at;
      return Pose.times(links[body.robot][body.link], this.opened(body, time));
    });
    return { time, joints, flanges, tools, bodies, parts };
  }
  opened(body, time) {
    if (body.gripper === undefined) return body.at;
    const widths = this.run.grippers[body.gripper].widths, off = widths[Math.max(lastAt(widths, time + MOMENT, since), 0)][1] / 2 - body.rest;
    return Pose.moved(body.at, body.way.map((value) => value * off));
  }
  // Null where it has not come yet, or was taken away.
  part(places, time, flanges) {
    const n = lastAt(places, time + MOMENT, since);
    if (n < 0 || places[n][1] === "gone") return null;
    const [t, state, robot, pose] = places[n], after = places[n + 1];
    if (state === "held" && flanges[robot]) return Pose.times(flanges[robot], pose);
    if (state !== "falls" || !after || after[0] <= t) return pose;
    const share = (time - t) / (after[0] - t);
    return Pose.moved(pose, [3, 7, 11].map((i) => share * (after[3][i] - pose[i])));
  }
}
