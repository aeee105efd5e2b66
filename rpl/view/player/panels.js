"use strict";
// What stands beside the scene: programs with their lines, joints, signals, events. All texts are set as text.

function made(tag, name, parent, text) {
  const found = document.createElement(tag);
  if (name) found.className = name;
  if (text !== undefined) found.textContent = text;
  if (parent) parent.append(found);
  return found;
}
const css = ([r, g, b]) => `rgb(${r}, ${g}, ${b})`;
const ROBOTS = [[232, 119, 34], [58, 124, 190], [46, 148, 108], [190, 110, 160]];

// One program: the text of the file that its task is in, with the line it is at.
class Program {
  constructor(run, number, parent, chosen) {
    this.run = run;
    this.number = number;
    this.robot = run.robots[number];
    this.task = 0;
    this.file = -1;
    this.here = null;
    const box = made("div", "program", parent), name = made("div", "name", box);
    made("i", "", name).style.background = css(ROBOTS[number % ROBOTS.length]);
    made("b", "", name, this.robot.name);
    this.place = made("span", "", name);
    this.text = made("div", "text", box);
    this.lines = this.robot.tasks.map((_, task) => this.robot.lines.filter((row) => row[3] === task));
    if (this.robot.tasks.length > 1) {
      const select = made("select", "", name);
      this.robot.tasks.forEach((task, n) => select.add(new Option(task, n)));
      select.addEventListener("change", () => { this.task = Number(select.value); this.file = -1; chosen(null); });
    }
    this.text.addEventListener("click", (event) => {
      const row = event.target.closest(".been");
      if (row) chosen(this.next(Number(row.dataset.line)));
    });
    this.at = 0;
  }
  // The next time (behind the present one, else the first) that the program comes to a line.
  next(line) {
    const times = this.robot.lines.filter((row) => row[1] === this.file && row[2] === line).map(since);
    return times.find((t) => t > this.at + MOMENT) ?? times[0];
  }
  show(time, forced) {
    this.at = time;
    const lines = this.lines[this.task] || [], row = forced || lines[Math.max(lastAt(lines, time + MOMENT, since), 0)];
    if (!row) { this.place.textContent = "no lines"; return; }
    if (this.file !== row[1]) this.open(row[1]);
    const line = this.rows.get(row[2]);
    this.place.textContent = this.run.files[row[1]].name + ":" + row[2];
    if (line === this.here) return;
    if (this.here) this.here.classList.remove("here");
    this.here = line || null;
    if (!line) return;
    line.classList.add("here");
    const box = this.text.getBoundingClientRect(), at = line.getBoundingClientRect();
    if (at.top < box.top + 20 || at.bottom > box.bottom - 20) this.text.scrollTop += at.top - box.top - box.height / 2.5;
  }
  open(file) {
    this.file = file;
    this.here = null;
    this.rows = new Map();
    const been = new Set(this.robot.lines.filter((row) => row[1] === file).map((row) => row[2]));
    const hit = new Set(this.run.events.filter((event) => event.file === file && (event.kind === "collision" || event.kind === "fault")).map((event) => event.line));
    const whole = document.createDocumentFragment();
    this.run.files[file].pieces.forEach(([first, text], n) => {
      if (n || first > 1) made("p", "", whole, "…");
      text.split("\n").forEach((words, k) => {
        const row = made("div", been.has(first + k) ? "been" : "", whole, words);
        row.dataset.line = first + k;
        if (hit.has(first + k)) row.classList.add("hit");
        this.rows.set(first + k, row);
      });
    });
    this.text.replaceChildren(whole);
  }
}

class Joints {
  constructor(run, parent) {
    this.rows = [];
    run.robots.forEach((robot, number) => {
      if (!robot.joints) return;
      if (run.robots.length > 1) made("h3", "", parent, robot.name);
      const list = robot.joints.map((joint) => {
        const row = made("div", "joint", parent);
        made("b", "", row, joint.name);
        const range = made("div", "range", row);
        range.title = joint.low + " to " + joint.high + " " + joint.unit;
        return { joint, row, mark: made("i", "", range), value: made("output", "", row) };
      });
      this.rows.push({ number, list, tool: made("div", "none", parent) });
    });
    if (!this.rows.length) made("div", "none", parent, "The run had no robot.");
  }
  show(state, motion) {
    this.rows.forEach(({ number, list, tool }) => {
      list.forEach(({ joint, row, mark, value }, n) => {
        const q = state.joints[number][n], share = joint.high > joint.low ? (q - joint.low) / (joint.high - joint.low) : 0.5;
        mark.style.left = 100 * Math.min(Math.max(share, 0), 1) + "%";
        row.classList.toggle("near", share < 0.02 || share > 0.98);
        value.textContent = q.toFixed(2) + (joint.unit === "deg" ? "°" : " mm");
      });
      const place = Pose.place(state.tools[number]).map((value) => value.toFixed(1)).join(", ");
      tool.textContent = "tool " + place + " mm, " + motion.arms[number].speedAt(state.time).toFixed(0) + " mm/s";
    });
  }
}

class Signals {
  constructor(run, parent) {
    this.rows = run.signals.map((signal) => {
      const row = made("div", "signal " + signal.kind, parent);
      made("i", "", row);
      made("span", "", row, (run.robots.length > 1 ? run.robots[signal.robot].name + " " : "") + signal.name);
      row.title = signal.kind;
      return { signal, row, value: made("output", "", row) };
    });
    if (!this.rows.length) made("div", "none", parent, "No signal changes.");
  }
  show(time) {
    this.rows.forEach(({ signal, row, value }) => {
      const n = lastAt(signal.changes, time + MOMENT, since), change = signal.changes[n];
      row.classList.toggle("on", Boolean(change && change[1]));
      value.textContent = change ? (signal.level && /^(TRUE|FALSE)$/.test(change[2]) ? "" : change[2]) : "";
    });
  }
}

class Events {
  constructor(run, parent, chosen) {
    this.list = run.events;
    this.rows = run.events.slice(0, 1000).map((event) => {
      const row = made("button", event.kind, parent);
      row.type = "button";
      made("b", "", row, event.t.toFixed(2));
      made("span", "", row, event.text + (event.file !== undefined ? " (" + run.files[event.file].name + ":" + event.line + ")" : ""));
      row.addEventListener("click", () => chosen(event.t));
      return row;
    });
    if (!this.rows.length) made("div", "none", parent, "No messages, grasps or collisions.");
  }
  show(time) {
    const now = lastAt(this.list, time + MOMENT, (event) => event.t);
    if (now === this.now) return;
    if (this.rows[this.now]) this.rows[this.now].classList.remove("now");
    this.now = now;
    if (this.rows[now]) this.rows[now].classList.add("now");
  }
}

// The bar of time: how fast each tool is, marks of what happens, and the present moment.
const MARKS = { collision: "#c0392b", fault: "#c0392b", misgrip: "#e07b00", warning: "#e07b00", grasp: "#2ea043", message: "#7a5195" };
class Bar {
  constructor(canvas, run, motion, chosen) {
    Object.assign(this, { canvas, run, motion, length: Math.max(run.time_s, 1e-6), back: document.createElement("canvas") });
    const pick = (event) => { const box = canvas.getBoundingClientRect(); chosen(this.length * Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1)); };
    canvas.addEventListener("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); pick(event); });
    canvas.addEventListener("pointermove", (event) => { if (event.buttons) pick(event); });
    canvas.setAttribute("aria-valuemin", "0");
    canvas.setAttribute("aria-valuemax", this.length.toFixed(3));
  }
  show(time) {
    const { canvas, back } = this, scale = window.devicePixelRatio || 1, width = Math.max(Math.round(canvas.clientWidth * scale), 1), height = Math.max(Math.round(canvas.clientHeight * scale), 1);
    if (back.width !== width || back.height !== height) { canvas.width = back.width = width; canvas.height = back.height = height; this.draw(width, height, scale); }
    const ink = canvas.getContext("2d"), x = (time / this.length) * width;
    ink.drawImage(back, 0, 0);
    ink.fillStyle = "#1d2733";
    ink.fillRect(x - scale, 0, 2 * scale, height);
    canvas.setAttribute("aria-valuenow", time.toFixed(3));
  }
  draw(width, height, scale) {
    const ink = this.back.getContext("2d"), x = (t) => (t / this.length) * width;
    ink.fillStyle = "#e9eef3";
    ink.fillRect(0, 0, width, height);
    const arms = this.motion.arms.filter(Boolean), top = 12 * scale, each = (height - top) / Math.max(arms.length, 1);
    arms.forEach((arm, n) => {
      const fastest = arm.speed.reduce((most, value) => Math.max(most, value), 1), low = top + each * (n + 1);
      ink.fillStyle = css(ROBOTS[this.motion.arms.indexOf(arm) % ROBOTS.length]);
      ink.globalAlpha = 0.55;
      ink.beginPath();
      ink.moveTo(0, low);
      arm.t.forEach((t, k) => ink.lineTo(x(t), low - (0.92 * each * arm.speed[k]) / fastest));
      ink.lineTo(x(arm.t[arm.t.length - 1]), low);
      ink.fill();
      ink.globalAlpha = 1;
    });
    this.run.events.forEach((event) => {
      const heavy = event.kind === "collision" || event.kind === "fault";
      ink.fillStyle = MARKS[event.kind] || "#7a5195";
      if (heavy) ink.fillRect(x(event.t) - scale / 2, 0, Math.max(scale, event.until ? x(event.until) - x(event.t) : 0), event.until ? 4 * scale : height);
      ink.beginPath();
      ink.arc(x(event.t), 6 * scale, (heavy ? 5 : 3.5) * scale, 0, 7);
      ink.fill();
    });
  }
}
