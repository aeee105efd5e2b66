"use strict";
// Puts scene, panels and player together.
(function () {
  const run = JSON.parse(document.getElementById("run").textContent), get = (id) => document.getElementById(id);
  const motion = new Motion(run), drawing = new Drawing(get("scene"));
  const state = { time: 0, playing: false, speed: 1, line: -1, follow: -1, dirty: true, frames: 0 };
  const shown = { path: true, frames: true, names: false, edges: true };
  get("facts").textContent = [run.time_s.toFixed(2) + " s", ...run.robots.filter((robot) => robot.title).map((robot) => (run.robots.length > 1 ? robot.name + ": " : "") + robot.title)].join(" · ");
  if (!motion.arms.some(Boolean)) get("legend").style.display = "none";
  if (!drawing.gl) { made("p", "fault", get("view"), "This browser has no WebGL 2: the cell cannot be drawn. The panels work."); }

  // ---- what is drawn

  const COLD = [[44, 47, 160], [31, 127, 208], [23, 182, 164], [122, 209, 81], [253, 231, 37], [249, 142, 9], [215, 48, 31]];
  function tint(share) {
    const at = Math.min(Math.max(share, 0), 1) * (COLD.length - 1), n = Math.min(Math.floor(at), COLD.length - 2);
    return COLD[n].map((value, k) => Math.round(value + (at - n) * (COLD[n + 1][k] - value)));
  }
  const shapes = [], geometry = run.shapes.map(({ v, f }) => ({ vertices: unpacked(v), faces: Uint32Array.from(unpacked(f)) }));
  geometry.forEach((one) => {
    one.ball = 0;
    for (let n = 0; n < one.vertices.length; n += 3) one.ball = Math.max(one.ball, Math.hypot(one.vertices[n], one.vertices[n + 1], one.vertices[n + 2]));
    if (drawing.gl) shapes.push(drawing.shape(one.vertices, one.faces));
  });

  function boundsOfAll() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const take = (p, r) => p.forEach((value, k) => { low[k] = Math.min(low[k], value - r); high[k] = Math.max(high[k], value + r); });
    const places = motion.at(0);
    run.bodies.forEach((body, n) => {
      if (!places.bodies[n]) return;
      const { vertices } = geometry[body.shape], step = 3 * Math.max(1, Math.floor(vertices.length / 900));
      for (let k = 0; k < vertices.length; k += step) take(Pose.point(places.bodies[n], [vertices[k], vertices[k + 1], vertices[k + 2]]), 0);
    });
    motion.arms.forEach((arm) => { if (arm) for (let k = 0; k < arm.path.length; k += 3) take([arm.path[k], arm.path[k + 1], arm.path[k + 2]], 0); });
    return low[0] <= high[0] ? [low, high] : [[-500, -500, 0], [500, 500, 500]];
  }
  const bounds = boundsOfAll(), camera = new Camera(bounds, get("scene").clientWidth / Math.max(get("scene").clientHeight, 1)), size = camera.radius;
  const fastest = motion.arms.reduce((most, arm) => (arm ? arm.speed.reduce((top, value) => Math.max(top, value), most) : most), 1);
  get("slow").textContent = "0";
  get("fast").textContent = fastest.toFixed(0) + " mm/s";

  function pathOf(arm) {
    const places = [], colours = [];
    for (let n = 0; n + 1 < arm.t.length; n++) {
      const [a, b] = [arm.path.subarray(3 * n, 3 * n + 3), arm.path.subarray(3 * n + 3, 3 * n + 6)];
      if (a[0] === b[0] && a[1] === b[1] && a[2] === b[2]) continue;
      places.push(...a, ...b);
      colours.push(...tint(arm.speed[n] / fastest), 255, ...tint(arm.speed[n + 1] / fastest), 255);
    }
    return drawing.pieces(places, colours);
  }
  function grid() {
    const step = [100, 200, 500, 1000, 2000, 5000].find((one) => size / one < 14) || 10000, floor = Math.min(bounds[0][2], 0) - 1;
    const ends = [0, 1].map((k) => [Math.floor((bounds[0][k] - 0.3 * size) / step) * step, Math.ceil((bounds[1][k] + 0.3 * size) / step) * step]);
    const places = [], colours = [], add = (...points) => { places.push(...points); colours.push(120, 136, 152, 80, 120, 136, 152, 80); };
    for (let x = ends[0][0]; x <= ends[0][1]; x += step) add(x, ends[1][0], floor, x, ends[1][1], floor);
    for (let y = ends[1][0]; y <= ends[1][1]; y += step) add(ends[0][0], y, floor, ends[0][1], y, floor);
    return drawing.pieces(places, colours);
  }
  const length = size * 0.09, axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], reds = [[214, 39, 40], [44, 140, 44], [31, 90, 200]];
  const made3d = drawing.gl && {
    grid: grid(),
    paths: motion.arms.map((arm) => arm && pathOf(arm)),
    triad: drawing.pieces(axes.flatMap((way) => [0, 0, 0, ...way.map((value) => value * length)]), reds.flatMap((colour) => [...colour, 255, ...colour, 255])),
    dot: drawing.shape(...octahedron(size * 0.006)),
    hit: drawing.shape(...octahedron(size * 0.018)),
  };
  function octahedron(r) {
    return [Float64Array.of(r, 0, 0, -r, 0, 0, 0, r, 0, 0, -r, 0, 0, 0, r, 0, 0, -r), Uint32Array.of(0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5)];
  }
  const at = (point) => Pose.moved(Pose.one(), point);
  const hits = run.events.filter((event) => event.kind === "collision");
  const SEEN_S = 0.25; // so long before and behind it a collision is shown in the scene
  const touching = () => hits.filter((event) => event.t - SEEN_S < state.time && state.time < event.until + SEEN_S);

  function draw(places) {
    const now = touching(), names = new Set(now.flatMap((event) => event.names));
    drawing.begin(camera);
    drawing.lines([{ pieces: made3d.grid, width: 1, flat: true }]);
    const bodies = run.bodies.map((body, n) => ({ shape: shapes[body.shape], place: places.bodies[n], colour: body.colour.map((value) => value / 255), alpha: body.kind === "sensor" ? 0.25 : 1, glow: names.has(body.name) ? 0.75 : 0, behind: body.link % 2 ? 6 : 0 })).filter((one) => one.place);
    places.tools.forEach((tool) => { if (tool) bodies.push({ shape: made3d.dot, place: tool, colour: [0.9, 0, 0.48], alpha: 1 }); });
    hits.forEach((event) => bodies.push({ shape: now.includes(event) ? made3d.hit : made3d.dot, place: at(event.point), colour: [0.85, 0.1, 0.1], alpha: 1, glow: 1 }));
    drawing.bodies(bodies);
    const lines = [];
    if (shown.path) made3d.paths.forEach((pieces) => { if (pieces) lines.push({ pieces, width: 2.6 }); });
    places.tools.forEach((tool, n) => { if (tool) lines.push({ pieces: stick(Pose.place(places.flanges[n]), Pose.place(tool)), width: 5 }); });
    if (shown.frames) framesNow(places).forEach(({ pose }) => lines.push({ pieces: made3d.triad, place: pose, width: 3, onTop: true, alpha: 0.9 }));
    drawing.lines(lines);
    if (stick.old) stick.old.forEach((pieces) => stick.free(pieces));
    stick.old = stick.made.splice(0);
  }
  // The way from flange to tool centre point, drawn anew for each frame.
  function stick(a, b) {
    const pieces = drawing.pieces([...a, ...b], [70, 80, 92, 255, 70, 80, 92, 255]);
    stick.made.push(pieces);
    return pieces;
  }
  stick.made = [];
  stick.free = (pieces) => { drawing.gl.deleteVertexArray(pieces.array); pieces.owned.forEach((buffer) => drawing.gl.deleteBuffer(buffer)); };

  function framesNow(places) {
    const found = [{ name: "cell", pose: Pose.one() }];
    run.robots.forEach((robot, n) => {
      if (!motion.arms[n]) return;
      const several = run.robots.length > 1 ? robot.name + " " : "";
      if (robot.base.some((value, k) => value !== Pose.one()[k])) found.push({ name: several + "base", pose: motion.arms[n].baseAt(places.time) });
      found.push({ name: several + "tool", pose: places.tools[n] });
    });
    return found;
  }

  // ---- names in the scene

  const labels = [];
  function drawLabels(places) {
    const wanted = [], { clientWidth: width, clientHeight: height } = get("scene");
    touching().slice(0, 4).forEach((event) => wanted.push([event.names.join(" × "), event.point, "hit"]));
    if (shown.names) {
      framesNow(places).forEach(({ name, pose }) => wanted.push([name, Pose.place(pose), ""]));
      run.bodies.forEach((body, n) => { if (places.bodies[n] && body.kind !== "arm" && body.kind !== "jaw" && wanted.length < 60) wanted.push([body.name, Pose.place(places.bodies[n]), ""]); });
    }
    while (labels.length < wanted.length) labels.push(made("span", "", get("labels")));
    labels.forEach((label, n) => {
      const seen = n < wanted.length && camera.seen(wanted[n][1], width, height);
      label.hidden = !seen;
      if (!seen) return;
      if (label.textContent !== wanted[n][0]) label.textContent = wanted[n][0];
      label.className = wanted[n][2];
      label.style.transform = "translate(" + (seen[0] + 8).toFixed(1) + "px, " + (seen[1] - 9 + (wanted[n][2] ? 18 * n : 0)).toFixed(1) + "px)"; // those of collisions below each other
    });
  }

  // What is under the pointer: the nearest body that the ray through it meets.
  function under(x, y) {
    const canvas = get("scene"), way = camera.ray(x, y, canvas.clientWidth, canvas.clientHeight), eye = camera.eye();
    let best = null, nearest = Infinity;
    run.bodies.forEach((body, n) => {
      if (!last.bodies[n]) return;
      const { vertices, faces, ball } = geometry[body.shape], back = Pose.inverse(last.bodies[n]), o = Pose.point(back, eye), d = Pose.point([...back.slice(0, 3), 0, ...back.slice(4, 7), 0, ...back.slice(8, 11), 0], way);
      const along = -(o[0] * d[0] + o[1] * d[1] + o[2] * d[2]), off = o[0] * o[0] + o[1] * o[1] + o[2] * o[2] - along * along;
      if (off > ball * ball || along + ball < 0) return;
      for (let f = 0; f < faces.length; f += 3) {
        const far = pierced(o, d, vertices, 3 * faces[f], 3 * faces[f + 1], 3 * faces[f + 2]);
        if (far < nearest) { nearest = far; best = body; }
      }
    });
    return best;
  }
  // How far a ray meets a triangle (Möller and Trumbore, 1997).
  function pierced(o, d, v, a, b, c) {
    const e = [v[b] - v[a], v[b + 1] - v[a + 1], v[b + 2] - v[a + 2]], g = [v[c] - v[a], v[c + 1] - v[a + 1], v[c + 2] - v[a + 2]];
    const p = [d[1] * g[2] - d[2] * g[1], d[2] * g[0] - d[0] * g[2], d[0] * g[1] - d[1] * g[0]], slant = e[0] * p[0] + e[1] * p[1] + e[2] * p[2];
    if (Math.abs(slant) < 1e-9) return Infinity;
    const s = [o[0] - v[a], o[1] - v[a + 1], o[2] - v[a + 2]], u = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / slant;
    const q = [s[1] * e[2] - s[2] * e[1], s[2] * e[0] - s[0] * e[2], s[0] * e[1] - s[1] * e[0]], w = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / slant;
    const far = (g[0] * q[0] + g[1] * q[1] + g[2] * q[2]) / slant;
    return u >= 0 && w >= 0 && u + w <= 1 && far > 0 ? far : Infinity;
  }
  get("scene").addEventListener("pointermove", (event) => {
    const tip = get("tip"), body = event.buttons ? null : under(event.offsetX, event.offsetY);
    tip.hidden = !body;
    if (body) { tip.textContent = body.name; tip.style.transform = "translate(" + (event.offsetX + 14) + "px, " + (event.offsetY + 10) + "px)"; }
  });
  get("scene").addEventListener("pointerleave", () => { get("tip").hidden = true; });

  // ---- the player

  const lines = run.robots.flatMap((robot, n) => robot.lines.map((row) => [row[0], n, row])).sort((a, b) => a[0] - b[0]);
  const programs = run.robots.map((_, n) => new Program(run, n, get("programs"), (t) => { if (t === null) change(); else go(t); }));
  const joints = new Joints(run, get("joints")), signals = new Signals(run, get("signals")), events = new Events(run, get("events"), go);
  const bar = new Bar(get("bar"), run, motion, go);
  let last = motion.at(0);

  function change() { state.dirty = true; }
  function go(time, line) {
    state.time = Math.min(Math.max(time, 0), run.time_s);
    state.line = line === undefined ? -1 : line;
    change();
  }
  function step(way) {
    play(false);
    const here = state.line >= 0 ? state.line : lastAt(lines, state.time + MOMENT, since);
    const next = Math.min(Math.max(here + way, 0), lines.length - 1);
    if (lines.length) go(lines[next][0], next);
  }
  function play(on) {
    state.playing = on === undefined ? !state.playing : on;
    if (state.playing && state.time >= run.time_s - MOMENT) go(0);
    get("play").textContent = state.playing ? "❚❚" : "▶";
    state.before = null;
    change();
  }
  function show() {
    last = motion.at(state.time);
    const forced = state.line >= 0 ? lines[state.line] : null;
    programs.forEach((program, n) => program.show(state.time, forced && forced[1] === n && forced[2][3] === program.task ? forced[2] : null));
    joints.show(last, motion);
    signals.show(state.time);
    events.show(state.time);
    bar.show(state.time);
    get("clock").textContent = state.time.toFixed(3) + " / " + run.time_s.toFixed(3) + " s";
    if (state.follow >= 0 && last.tools[state.follow]) camera.target = Pose.place(last.tools[state.follow]);
    if (drawing.gl) { draw(last); drawLabels(last); }
    state.frames++;
  }
  function frame(moment) {
    if (state.playing) {
      if (state.before !== null) {
        state.time += (state.speed * (moment - state.before)) / 1000;
        state.line = -1;
        if (state.time >= run.time_s) { state.time = run.time_s; play(false); }
      }
      state.before = moment;
      state.dirty = true;
    }
    if (state.dirty) { state.dirty = false; show(); }
    requestAnimationFrame(frame);
  }

  const views = Object.keys(VIEWS);
  function look(name) {
    if (VIEWS[name]) { state.follow = -1; camera.aspect = get("scene").clientWidth / Math.max(get("scene").clientHeight, 1); camera.view(name); }
    else { state.follow = Math.max(motion.arms.findIndex(Boolean), 0); camera.zoom(0.45); }
    [...get("cameras").children].forEach((button) => button.classList.toggle("on", button.textContent === name));
    change();
  }
  [...views, ...(motion.arms.some(Boolean) ? ["follow tool"] : [])].forEach((name) => {
    const button = made("button", name === "isometric" ? "on" : "", get("cameras"), name);
    button.type = "button";
    button.addEventListener("click", () => look(name));
  });
  ["path", "frames", "names"].forEach((name) => {
    const label = made("label", "", get("shown")), box = made("input", "", label);
    box.type = "checkbox";
    box.checked = shown[name];
    label.append(name);
    box.addEventListener("change", () => { shown[name] = box.checked; change(); });
  });
  camera.listen(get("scene"), change);
  [0.1, 0.25, 0.5, 1, 2, 5, 10].forEach((value) => get("speed").add(new Option("× " + value, value, value === 1, value === 1)));
  get("speed").addEventListener("change", () => { state.speed = Number(get("speed").value); });
  get("play").addEventListener("click", () => play());
  get("start").addEventListener("click", () => { play(false); go(0); });
  get("before").addEventListener("click", () => step(-1));
  get("after").addEventListener("click", () => step(1));
  const KEYS = { " ": () => play(), ArrowLeft: () => step(-1), ArrowRight: () => step(1), Home: () => go(0), End: () => go(run.time_s) };
  document.addEventListener("keydown", (event) => {
    if (event.target.closest("select, input, button") && event.key !== "Home" && event.key !== "End" && !event.key.startsWith("Arrow")) return;
    if (event.target.closest("select")) return;
    if (KEYS[event.key]) { event.preventDefault(); KEYS[event.key](); }
  });
  window.addEventListener("resize", change);
  // `#t=3.5&view=top&names=1` opens the page at a moment, from a side; kept in links.
  const asked = new URLSearchParams(location.hash.slice(1));
  if (VIEWS[asked.get("view")] || asked.get("view") === "follow tool") look(asked.get("view"));
  ["path", "frames", "names"].forEach((name, n) => { if (asked.has(name)) { shown[name] = asked.get(name) !== "0"; get("shown").children[n].firstChild.checked = shown[name]; } });
  if (Number.isFinite(Number(asked.get("t")))) go(Number(asked.get("t")));
  document.documentElement.dataset.frames = "0";
  setInterval(() => { document.documentElement.dataset.frames = state.frames; }, 500);
  requestAnimationFrame(frame);
})();
