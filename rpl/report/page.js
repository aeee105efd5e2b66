"use strict";
(function () {
  const run = JSON.parse(document.getElementById("run").textContent);
  const samples = run.samples || null;
  const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b8860b", "#56b4e9", "#444444", "#7a5195"];
  const KINDS = { joint: "#8da0b3", linear: "#2b8cbe", circular: "#41ab5d", spline: "#9e6bb5" };
  const GRID = "#e9edf1", LIMIT = "#c0392b", FONT = { family: "system-ui, 'Segoe UI', Roboto, Arial, sans-serif", size: 11, color: "#1d2733" };
  const WHOLE = [-0.004, 1.008].map((share) => share * (run.time_s || 1)); // what happens at the very end is inside
  const SETTINGS = { responsive: true, displaylogo: false, modeBarButtonsToRemove: ["lasso2d", "select2d"] };

  // The library reads markup in labels: texts of the program are escaped first.
  const escaped = (text) => String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
  const labels = run.labels.map(([place, text]) => "<b>" + escaped(place) + "</b>  " + escaped(text));
  const label = (number, otherwise) => (number >= 0 ? labels[number] : otherwise || "");

  // For each sample the text of its line, and its move.
  const lines = [], owners = [];
  if (samples) {
    run.stretches.forEach(([first, move, number], place) => {
      const next = place + 1 < run.stretches.length ? run.stretches[place + 1][0] : samples.t.length;
      const text = move >= 0 ? label(number) : "standing" + (number >= 0 ? "<br>" + label(number) : "");
      for (let i = first; i < next; i++) { lines[i] = text; owners[i] = move; }
    });
  }

  // ---- tool path

  const chosen = { move: -1 }, now = { row: 0 };
  const armShown = () => document.getElementById("arm").checked;

  // The arm as a line through its axes, from its base to the flange and on to the tool.
  function stick(row) {
    const links = armLinks(Pose.one(), run.arm, samples.joints.map((axis) => axis[row]));
    const points = run.arm.points.map((point, n) => Pose.point(links[n], point));
    if (points[0].some((value) => Math.abs(value) > 1)) points.unshift([0, 0, 0]);
    return [...points, Pose.place(Pose.times(links[links.length - 1], run.arm.flange)), samples.tool.map((axis) => axis[row])];
  }
  const columns = (points) => ({ x: points.map((p) => p[0]), y: points.map((p) => p[1]), z: points.map((p) => p[2]) });

  // Of the path, and of the arm where it is shown: lowest and highest value of each axis.
  function pathBounds() {
    const bounds = samples.tool.map((axis) => axis.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], [Infinity, -Infinity]));
    const step = Math.max(1, Math.floor(samples.t.length / 60));
    if (armShown()) for (let row = 0; row < samples.t.length; row += step) stick(row).forEach((point) => point.forEach((v, k) => { bounds[k] = [Math.min(bounds[k][0], v), Math.max(bounds[k][1], v)]; }));
    return bounds;
  }
  const COLOURINGS = {
    "tool speed": () => [samples.tool_speed, "mm/s"],
    "singularity margin": () => [samples.conditioning, "1/cond"],
    "time": () => [samples.t, "s"],
  };

  function pathRows(move) {
    const rows = [];
    if (move < 0) return rows;
    for (let i = 0; i < owners.length; i++) if (owners[i] === move) rows.push(i);
    return rows;
  }
  const pick = (values, rows) => rows.map((i) => values[i]);
  const HOVER = "%{text}<br>t = %{customdata[0]:.3f} s, %{customdata[1]:.0f} mm/s";

  function switchings() {
    const found = { rows: [], text: [] };
    run.signals.filter((row) => row.kind === "output").forEach((row) => row.changes.forEach(([t, , value, number]) => {
      found.rows.push(rowAt(t));
      found.text.push("<b>" + escaped(row.name) + " = " + escaped(value) + "</b> at " + t.toFixed(3) + " s<br>" + label(number));
    }));
    return found;
  }

  function rowAt(t) {
    let low = 0, high = samples.t.length - 1;
    while (low < high) { const middle = (low + high) >> 1; if (samples.t[middle] < t) low = middle + 1; else high = middle; }
    return low;
  }

  function ends() {
    const rows = [];
    run.stretches.forEach(([first, move], place) => {
      if (move >= 0) rows.push((place + 1 < run.stretches.length ? run.stretches[place + 1][0] : samples.t.length) - 1);
    });
    return rows;
  }

  const custom = samples ? samples.t.map((t, i) => [t, samples.tool_speed[i]]) : [];

  function drawPath() {
    const [values, unit] = COLOURINGS[document.getElementById("colour").value]();
    const [x, y, z] = samples.tool, targets = ends(), outputs = switchings(), picked = pathRows(chosen.move);
    const at = (rows) => ({ x: pick(x, rows), y: pick(y, rows), z: pick(z, rows) });
    const data = [
      { type: "scatter3d", mode: "lines", name: "path", x, y, z, text: lines, customdata: custom, hovertemplate: HOVER + "<br>%{x:.1f}, %{y:.1f}, %{z:.1f} mm<extra></extra>",
        line: { color: values, colorscale: "Viridis", width: 5, showscale: true, colorbar: { title: { text: unit, side: "right" }, thickness: 12, len: 0.6, x: 1 } } },
      { type: "scatter3d", mode: "markers", name: "ends of moves", ...at(targets), text: pick(lines, targets), hovertemplate: "%{text}<br>%{x:.1f}, %{y:.1f}, %{z:.1f} mm<extra></extra>", marker: { size: 2.5, color: "#1d2733" } },
      { type: "scatter3d", mode: "markers", name: "outputs", ...at(outputs.rows), text: outputs.text, hovertemplate: "%{text}<extra></extra>", marker: { size: 4, color: "#d55e00", symbol: "diamond" } },
      { type: "scatter3d", mode: "lines", name: "chosen move", ...at(picked), hoverinfo: "skip", line: { color: "#e6007a", width: 10 } },
      { type: "scatter3d", mode: "markers", name: "now", ...at([now.row]), hoverinfo: "skip", marker: { size: 7, color: "#e6007a" } },
      { type: "scatter3d", mode: "lines+markers", name: "arm", visible: armShown(), ...columns(stick(now.row)), hoverinfo: "skip", line: { color: "#e87722", width: 14 }, marker: { size: 6, color: "#8a3f06" } },
    ];
    // One scale for all three axes, the longest as wide as the view: a long thin path stays inside, a flat one visible.
    const bounds = pathBounds();
    const longest = Math.max(1, ...bounds.map(([low, high]) => high - low));
    const widths = bounds.map(([low, high]) => 1.06 * Math.max(high - low, 0.2 * longest));
    const ratios = widths.map((width) => (1.5 * width) / (1.06 * longest));
    const axis = (title, n) => ({ title: { text: title }, range: [-0.5, 0.5].map((side) => 0.5 * (bounds[n][0] + bounds[n][1]) + side * widths[n]), gridcolor: GRID, zerolinecolor: "#c5ced8", backgroundcolor: "#fff" });
    Plotly.react("path", data, {
      font: FONT, margin: { l: 0, r: 0, t: 0, b: 0 }, uirevision: "path", showlegend: true, legend: { orientation: "h", y: 0, x: 0 },
      scene: { aspectmode: "manual", aspectratio: { x: ratios[0], y: ratios[1], z: ratios[2] }, xaxis: axis("X", 0), yaxis: axis("Y", 1), zaxis: axis("Z", 2), camera: { eye: { x: 1.6, y: -1.8, z: 1.0 }, center: { x: 0, y: 0, z: -0.1 } } },
    }, SETTINGS);
    drawPlanes(values, targets, outputs, picked);
  }

  function drawPlanes(values, targets, outputs, picked) {
    const [x, y, z] = samples.tool;
    const planes = [["top", x, y, "X", "Y"], ["front", x, z, "X", "Z"], ["side", y, z, "Y", "Z"]];
    const heights = [[0.71, 1], [0.36, 0.64], [0, 0.29]];
    const kind = samples.t.length > 4000 ? "scattergl" : "scatter";
    const data = [], layout = { font: FONT, margin: { l: 52, r: 8, t: 16, b: 30 }, showlegend: false, hovermode: "closest", uirevision: "planes", annotations: [] };
    planes.forEach(([name, u, v, first, second], n) => {
      const s = n ? n + 1 : "", axes = { xaxis: "x" + s, yaxis: "y" + s };
      data.push({ type: kind, mode: "lines", x: u, y: v, text: lines, customdata: custom, hovertemplate: HOVER + "<extra></extra>", line: { color: "#2b6ca3", width: 1.4 }, ...axes });
      data.push({ type: kind, mode: "markers", x: pick(u, targets), y: pick(v, targets), text: pick(lines, targets), hovertemplate: "%{text}<extra></extra>", marker: { size: 4, color: "#1d2733" }, ...axes });
      data.push({ type: kind, mode: "markers", x: pick(u, outputs.rows), y: pick(v, outputs.rows), text: outputs.text, hovertemplate: "%{text}<extra></extra>", marker: { size: 7, color: "#d55e00", symbol: "diamond-open" }, ...axes });
      data.push({ type: "scatter", mode: "lines", x: pick(u, picked), y: pick(v, picked), hoverinfo: "skip", line: { color: "#e6007a", width: 3 }, ...axes });
      layout["xaxis" + s] = { title: { text: first + " mm", standoff: 4 }, gridcolor: GRID, zeroline: false, anchor: "y" + s };
      layout["yaxis" + s] = { title: { text: second + " mm", standoff: 4 }, gridcolor: GRID, zeroline: false, anchor: "x" + s, domain: heights[n], scaleanchor: "x" + s };
      layout.annotations.push({ text: name, xref: "paper", yref: "paper", x: 0, y: heights[n][1], xanchor: "left", yanchor: "bottom", showarrow: false, font: { color: "#5c6b7a" } });
    });
    Plotly.react("planes", data, layout, SETTINGS);
  }

  // ---- over time: rows with one time axis

  function Rows() {
    const gap = 30, rows = [];
    return {
      add(title, height, axis) { rows.push({ title, height, axis: axis || {} }); return rows.length === 1 ? "y" : "y" + rows.length; },
      layout() {
        const whole = rows.reduce((sum, row) => sum + row.height + gap, 0), layout = { height: whole + 90, annotations: [] };
        let top = whole;
        rows.forEach((row, n) => {
          const domain = [Math.max((top - gap - row.height) / whole, 0), (top - gap) / whole], key = n ? "yaxis" + (n + 1) : "yaxis";
          layout[key] = { domain, gridcolor: GRID, zerolinecolor: "#c5ced8", automargin: false, fixedrange: false, ...row.axis };
          layout.annotations.push({ text: "<b>" + row.title + "</b>", xref: "paper", yref: "paper", x: 0, y: domain[1], xanchor: "left", yanchor: "bottom", showarrow: false });
          top -= row.height + gap;
        });
        layout.last = rows.length;
        return layout;
      },
    };
  }

  function jointRows(rows, data, shapes, mode) {
    const share = mode === "share", kind = samples.t.length > 4000 ? "scattergl" : "scatter";
    const per = { positions: "", speeds: "/s", accelerations: "/s²" };
    const quantities = [
      ["Joint positions", "positions", samples.joints, (j) => (v) => (j.low === null || j.high === null || j.high <= j.low ? 0 : (200 * (v - j.low)) / (j.high - j.low) - 100), (j) => [j.low, j.high]],
      ["Joint speeds", "speeds", samples.speeds, (j) => (v) => (100 * v) / (j.speed || Infinity), (j) => [-j.speed, j.speed]],
      ["Joint accelerations", "accelerations", samples.accelerations, (j) => (v) => (100 * v) / (j.acceleration || Infinity), (j) => [-j.acceleration, j.acceleration]],
    ];
    quantities.forEach(([title, key, values, scaled, limits], q) => {
      const unit = share ? (q ? "% of limit" : "% of range") : "deg or mm" + per[key];
      const axis = rows.add(title + ", " + unit, 180, { ticksuffix: share ? " %" : "" });
      run.joints.forEach((joint, n) => {
        data.push({
          type: kind, mode: "lines", name: joint.name, legendgroup: joint.name, showlegend: q === 0, x: samples.t, yaxis: axis,
          y: share ? values[n].map(scaled(joint)) : values[n], customdata: values[n], text: lines, line: { color: COLOURS[n % COLOURS.length], width: 1.3 },
          hovertemplate: "%{text}<br>" + joint.name + " %{customdata:.2f} " + joint.unit + per[key] + (share ? " (%{y:.1f} %)" : "") + " at %{x:.3f} s<extra></extra>",
        });
        if (!share) limits(joint).forEach((limit) => {
          if (limit !== null && Number.isFinite(limit)) data.push({ type: "scatter", mode: "lines", legendgroup: joint.name, showlegend: false, hoverinfo: "skip", x: [0, run.time_s], y: [limit, limit], yaxis: axis, line: { color: COLOURS[n % COLOURS.length], width: 1, dash: "dot" } });
        });
      });
      if (share) [-100, 100].forEach((y) => shapes.push(limitLine(axis, y)));
    });
  }

  const limitLine = (axis, y) => ({ type: "line", xref: "x", yref: axis, x0: 0, x1: run.time_s, y0: y, y1: y, line: { color: LIMIT, width: 1, dash: "dash" } });

  function ribbon(rows, data) {
    const axis = rows.add("Moves", 26, { visible: false, range: [-0.5, 0.5], fixedrange: true });
    Object.keys(KINDS).forEach((kind) => {
      const moves = run.moves.filter((move) => move.kind === kind);
      if (!moves.length) return;
      data.push({
        type: "bar", orientation: "h", name: kind, showlegend: false, base: moves.map((m) => m.start), x: moves.map((m) => m.end - m.start), y: moves.map(() => 0), yaxis: axis, width: 0.9,
        marker: { color: KINDS[kind], line: { color: "#fff", width: 1 } }, text: moves.map((m) => label(m.label)), textposition: "none", customdata: moves.map((m) => [m.end - m.start, m.length]),
        hovertemplate: "%{text}<br>" + kind + ", %{customdata[0]:.3f} s, %{customdata[1]:.1f} mm<extra></extra>",
      });
    });
  }

  function margins(rows, data, shapes) {
    const kind = samples.t.length > 4000 ? "scattergl" : "scatter";
    const axis = rows.add("Singularity margin (0: singular)", 140, { rangemode: "tozero" });
    const line = (name, values, colour, width, dash) => data.push({ type: kind, mode: "lines", name, showlegend: true, legendgroup: "margin " + name, x: samples.t, y: values, yaxis: axis, text: lines, line: { color: colour, width, dash }, hovertemplate: "%{text}<br>" + name + " %{y:.3f} at %{x:.3f} s<extra></extra>" });
    line("1 / condition", samples.conditioning, "#1d2733", 1.8, "solid");
    const tints = { wrist: "#d55e00", elbow: "#009e73", shoulder: "#cc79a7" };
    Object.entries(samples.factors).forEach(([name, values]) => line(name, values, tints[name] || "#777", 1.2, "dot"));
    const room = rows.add("Joint limit margin, % of half range (0: at the limit)", 140, { ticksuffix: " %", rangemode: "tozero" });
    run.joints.forEach((joint, n) => {
      if (joint.low === null || joint.high === null || joint.high <= joint.low) return;
      const half = (joint.high - joint.low) / 2;
      data.push({
        type: kind, mode: "lines", legendgroup: joint.name, showlegend: false, name: joint.name, x: samples.t, yaxis: room, text: lines, line: { color: COLOURS[n % COLOURS.length], width: 1.3 },
        y: samples.joints[n].map((q) => (100 * Math.min(q - joint.low, joint.high - q)) / half), customdata: samples.joints[n].map((q) => Math.min(q - joint.low, joint.high - q)),
        hovertemplate: "%{text}<br>" + joint.name + " %{customdata:.2f} " + joint.unit + " to its limit (%{y:.1f} %) at %{x:.3f} s<extra></extra>",
      });
    });
    shapes.push(limitLine(room, 0));
  }

  function layers(rows, data, shapes) {
    const groups = new Map();
    const group = (layer) => layer.title + "\n" + layer.unit;
    run.layers.forEach((layer) => groups.set(group(layer), (groups.get(group(layer)) || []).concat([layer])));
    groups.forEach((members) => {
      const { unit, title } = members[0], names = [...new Set(members.map((layer) => layer.name.replace(/ J\d+$/, "s")))].join("; ");
      const axis = rows.add((title ? title + ": " : "") + names + ", " + unit, 150, {});
      members.forEach((layer, n) => {
        const joint = /J(\d+)$/.exec(layer.name), colour = COLOURS[(joint ? joint[1] - 1 : n) % COLOURS.length];
        layer.limits.forEach((limit) => data.push({ type: "scatter", mode: "lines", showlegend: false, hoverinfo: "skip", x: [0, run.time_s], y: [limit, limit], yaxis: axis, line: { color: colour, width: 1, dash: "dot" } }));
        const text = samples ? layer.t.map((t) => lines[rowAt(t)]) : undefined;
        data.push({ type: "scattergl", mode: "lines", name: layer.name, legendgroup: joint ? joint[0] : layer.name, showlegend: !joint && !/speeds/i.test(title), x: layer.t, y: layer.values, yaxis: axis, text, line: { color: colour, width: 1.3 }, hovertemplate: "%{text}<br>" + escaped(layer.name) + " %{y:.3f} " + escaped(unit) + " at %{x:.3f} s<extra></extra>" });
      });
      if (unit === "% of limit") [-100, 100].forEach((y) => shapes.push(limitLine(axis, y)));
    });
  }

  function signals(rows, data) {
    if (!run.signals.length) return;
    const count = run.signals.length;
    const axis = rows.add("Inputs and outputs", 20 * count + 10, { range: [-0.2, count], tickvals: run.signals.map((_, n) => count - n - 0.65), ticktext: run.signals.map((row) => escaped(row.name)), showgrid: false, zeroline: false, fixedrange: true });
    run.signals.forEach((row, n) => {
      const base = count - n - 1, values = row.changes.map((change) => change[1]);
      const low = row.level ? 0 : Math.min(0, ...values), high = row.level ? 1 : Math.max(...values), span = high > low ? high - low : 1;
      const height = (value) => base + (0.7 * (value - low)) / span;
      const last = row.changes[row.changes.length - 1], colour = row.kind === "output" ? "#d55e00" : "#0072b2";
      const x = [0, ...row.changes.map((change) => change[0]), run.time_s], y = [base, ...values.map(height), height(last[1])];
      data.push({ type: "scatter", mode: "lines", x: [0, run.time_s], y: [base, base], yaxis: axis, hoverinfo: "skip", showlegend: false, line: { color: "#dde3ea", width: 1 } });
      data.push({ type: "scatter", mode: "lines", x, y, yaxis: axis, hoverinfo: "skip", showlegend: false, line: { color: colour, width: 1.4, shape: "hv" }, fill: "tonexty", fillcolor: row.kind === "output" ? "rgba(213,94,0,.18)" : "rgba(0,114,178,.18)" });
      data.push({ type: "scatter", mode: "markers", name: row.name, x: row.changes.map((change) => change[0]), y: values.map(height), yaxis: axis, showlegend: false, marker: { size: 5, color: colour }, text: row.changes.map(([, , value, number]) => "<b>" + escaped(row.name) + " = " + escaped(value) + "</b><br>" + label(number, row.kind === "input" ? "from the surroundings" : "")), hovertemplate: "%{text}<br>at %{x:.3f} s<extra></extra>" });
    });
  }

  function marks(rows, data) {
    if (!run.marks.length) return;
    const axis = rows.add("Messages", 22, { visible: false, range: [-1, 1], fixedrange: true });
    data.push({ type: "scatter", mode: "markers", x: run.marks.map((mark) => mark.t), y: run.marks.map(() => 0), yaxis: axis, showlegend: false, marker: { size: 8, symbol: run.marks.map((mark) => (mark.kind === "fault" ? "x" : "circle")), color: run.marks.map((mark) => (mark.kind === "fault" ? LIMIT : "#7a5195")) }, text: run.marks.map((mark) => escaped(mark.text) + "<br>" + label(mark.label)), hovertemplate: "%{text}<br>at %{x:.3f} s<extra></extra>" });
  }

  function drawTime(mode) {
    const rows = Rows(), data = [], shapes = [];
    if (samples) {
      ribbon(rows, data);
      const speed = rows.add("Tool speed, mm/s", 130, { rangemode: "tozero" });
      data.push({ type: samples.t.length > 4000 ? "scattergl" : "scatter", mode: "lines", name: "tool speed", showlegend: false, x: samples.t, y: samples.tool_speed, yaxis: speed, text: lines, customdata: samples.turning, line: { color: "#0b63b0", width: 1.5 }, hovertemplate: "%{text}<br>%{y:.1f} mm/s, turning %{customdata:.1f} deg/s, at %{x:.3f} s<extra></extra>" });
    }
    signals(rows, data);
    marks(rows, data);
    if (samples) { jointRows(rows, data, shapes, mode); margins(rows, data, shapes); }
    layers(rows, data, shapes);
    const { last, ...placed } = rows.layout();
    const old = document.getElementById("time").layout, range = old && old.xaxis && !old.xaxis.autorange ? old.xaxis.range.slice() : WHOLE;
    Plotly.react("time", data, {
      ...placed, font: FONT, shapes, margin: { l: 90, r: 12, t: 4, b: 40 }, hovermode: "closest", barmode: "overlay", dragmode: "zoom", uirevision: "time",
      legend: { orientation: "h", y: 1, yanchor: "bottom", x: 0 }, plot_bgcolor: "#fff",
      xaxis: { title: { text: "time, s" }, range, gridcolor: GRID, zeroline: false, anchor: last > 1 ? "y" + last : "y", showspikes: true, spikemode: "across", spikesnap: "cursor", spikethickness: 1, spikedash: "solid", spikecolor: "#9aa8b5" },
    }, SETTINGS);
  }

  // ---- what is under the pointer, in all drawings

  function show(row) {
    const readout = document.getElementById("readout");
    const value = (name, text) => "<span>" + name + " " + text + "</span>";
    readout.innerHTML = "<b>" + samples.t[row].toFixed(3) + " s</b> &nbsp; " + lines[row].replace("<br>", " ") + "<br>" + value("tool", samples.tool.map((axis) => axis[row].toFixed(1)).join(", ") + " mm") + value("", samples.tool_speed[row].toFixed(0) + " mm/s") +
      run.joints.map((joint, n) => value(joint.name, samples.joints[n][row].toFixed(2) + " " + joint.unit + " (" + ((100 * Math.abs(samples.speeds[n][row])) / (joint.speed || Infinity)).toFixed(0) + " %)")).join("");
    now.row = row;
    const arm = columns(stick(row)), [x, y, z] = samples.tool.map((axis) => axis[row]);
    Plotly.restyle("path", { x: [[x], arm.x], y: [[y], arm.y], z: [[z], arm.z] }, [4, 5]);
    document.getElementById("moment").value = samples.t[row];
    document.getElementById("clock").textContent = samples.t[row].toFixed(3) + " / " + run.time_s.toFixed(3) + " s";
  }

  // The bar below the path: plays the run, or is dragged to a time.
  function listenToPlayer() {
    const bar = document.getElementById("moment"), button = document.getElementById("play"), pace = document.getElementById("pace");
    const clock = { on: false, time: 0, before: 0 };
    [0.1, 0.25, 0.5, 1, 2, 5, 10].forEach((value) => pace.add(new Option("× " + value, value, value === 1, value === 1)));
    function tick(moment) {
      if (!clock.on) return;
      clock.time = Math.min(clock.time + (Number(pace.value) * (moment - clock.before)) / 1000, run.time_s);
      clock.before = moment;
      show(rowAt(clock.time));
      if (clock.time >= run.time_s) play(false); else requestAnimationFrame(tick);
    }
    function play(on) {
      clock.on = on;
      button.textContent = on ? "❚❚" : "▶";
      if (!on) return;
      clock.time = samples.t[now.row] >= run.time_s - 1e-3 ? 0 : samples.t[now.row];
      requestAnimationFrame((moment) => { clock.before = moment; tick(moment); });
    }
    button.addEventListener("click", () => play(!clock.on));
    bar.addEventListener("input", () => { play(false); show(rowAt(Number(bar.value))); });
    document.addEventListener("keydown", (event) => { if (event.key === " " && event.target === document.body) { event.preventDefault(); play(!clock.on); } });
    document.getElementById("arm").addEventListener("change", drawPath);
  }

  function choose(move) {
    chosen.move = chosen.move === move ? -1 : move;
    document.querySelectorAll("#moves tbody tr").forEach((row) => row.classList.toggle("chosen", Number(row.dataset.move) === chosen.move));
    const { start, end } = run.moves[chosen.move] || { start: 0, end: 0 }, pad = Math.max(0.05, 0.1 * (end - start));
    Plotly.relayout("time", { "xaxis.range": chosen.move >= 0 ? [start - pad, end + pad] : WHOLE });
    drawPath();
  }

  let mode = "share";
  drawTime(mode);
  if (samples) {
    const select = document.getElementById("colour");
    Object.keys(COLOURINGS).forEach((name) => select.add(new Option(name, name)));
    select.addEventListener("change", drawPath);
    drawPath();
    listenToPlayer();
    show(0);
    document.querySelectorAll(".choice button").forEach((button) => button.addEventListener("click", () => {
      mode = button.dataset.mode;
      document.querySelectorAll(".choice button").forEach((other) => other.classList.toggle("on", other === button));
      drawTime(mode);
    }));
    let waiting = false;
    const follow = (event) => {
      const point = event.points[0];
      if (waiting || !point || typeof point.x !== "number") return;
      waiting = true;
      requestAnimationFrame(() => { waiting = false; show(rowAt(point.data.orientation === "h" ? point.base : point.x)); });
    };
    document.getElementById("time").on("plotly_hover", follow);
    document.querySelectorAll("#moves tbody tr").forEach((row) => {
      row.addEventListener("click", () => choose(Number(row.dataset.move)));
      row.addEventListener("keydown", (event) => { if (event.key === "Enter") choose(Number(row.dataset.move)); });
    });
  }
})();
