"use strict";
// Bodies of triangles with their edges, and wide lines, drawn by WebGL 2.

const BODY_VERTEX = `#version 300 es
in vec3 position; in vec3 normal; uniform mat4 place, camera; out vec3 facing, where;
void main() { vec4 world = place * vec4(position, 1.0); where = world.xyz; facing = mat3(place) * normal; gl_Position = camera * world; }`;
const BODY_FRAGMENT = `#version 300 es
precision highp float; in vec3 facing, where; uniform vec4 colour; uniform vec3 eye; uniform float glow; out vec4 shown;
void main() {
  vec3 n = normalize(facing), toEye = normalize(eye - where);
  if (dot(n, toEye) < 0.0) n = -n;
  vec3 key = normalize(toEye + vec3(0.25, -0.35, 0.9));
  float light = 0.40 + 0.14 * n.z + 0.52 * max(dot(n, key), 0.0), spark = 0.16 * pow(max(dot(reflect(-key, n), toEye), 0.0), 24.0);
  vec3 lit = mix(colour.rgb, vec3(0.9, 0.05, 0.05), glow) * light + spark;
  shown = vec4(lit * colour.a, colour.a);
}`;
const EDGE_FRAGMENT = `#version 300 es
precision highp float; in vec3 facing, where; uniform vec4 colour; out vec4 shown;
void main() { shown = vec4(colour.rgb * 0.42 * colour.a, colour.a); }`;
const LINE_VERTEX = `#version 300 es
in vec2 corner; in vec3 start, end; in vec4 first, last; uniform mat4 place, camera; uniform vec2 size; uniform float width, near, nearer; out vec4 tint;
void main() {
  vec4 a = camera * place * vec4(start, 1.0), b = camera * place * vec4(end, 1.0);
  tint = mix(first, last, corner.x);
  if (a.w < near && b.w < near) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  if (a.w < near) a = mix(b, a, (b.w - near) / (b.w - a.w));
  if (b.w < near) b = mix(a, b, (a.w - near) / (a.w - b.w));
  vec2 along = (b.xy / b.w - a.xy / a.w) * size;
  float length = length(along);
  along = length > 1e-6 ? along / length : vec2(1.0, 0.0);
  vec4 point = mix(a, b, corner.x);
  vec2 off = vec2(-along.y, along.x) * corner.y + along * (corner.x - 0.5);
  point.xy += off * width / size * point.w;
  point.z -= nearer * point.w;
  gl_Position = point;
}`;
const LINE_FRAGMENT = `#version 300 es
precision highp float; in vec4 tint; uniform float alpha; out vec4 shown;
void main() { shown = vec4(tint.rgb, 1.0) * tint.a * alpha; }`;

// Faces that meet at less than this look round, those that meet at more have an edge.
const ROUND = Math.cos((32 * Math.PI) / 180);

// Corners of all triangles with the normals that make round faces look round, and the edges between the others.
function shaded(vertices, faces) {
  const names = new Map(), owner = new Int32Array(vertices.length / 3), around = [];
  for (let n = 0; n < owner.length; n++) {
    const name = vertices[3 * n].toFixed(2) + "," + vertices[3 * n + 1].toFixed(2) + "," + vertices[3 * n + 2].toFixed(2);
    if (!names.has(name)) { names.set(name, around.length); around.push([]); }
    owner[n] = names.get(name);
  }
  const count = faces.length / 3, across = new Float32Array(3 * count), area = new Float32Array(count), position = new Float32Array(9 * count);
  for (let f = 0; f < count; f++) {
    for (let c = 0; c < 3; c++) {
      for (let k = 0; k < 3; k++) position[9 * f + 3 * c + k] = vertices[3 * faces[3 * f + c] + k];
      around[owner[faces[3 * f + c]]].push(f);
    }
    const p = position.subarray(9 * f, 9 * f + 9), u = [p[3] - p[0], p[4] - p[1], p[5] - p[2]], v = [p[6] - p[0], p[7] - p[1], p[8] - p[2]];
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]], size = Math.hypot(...n) || 1;
    area[f] = size;
    for (let k = 0; k < 3; k++) across[3 * f + k] = n[k] / size;
  }
  const dot = (f, g) => across[3 * f] * across[3 * g] + across[3 * f + 1] * across[3 * g + 1] + across[3 * f + 2] * across[3 * g + 2];
  const normal = new Float32Array(9 * count);
  for (let f = 0; f < count; f++) for (let c = 0; c < 3; c++) {
    const sum = [0, 0, 0];
    for (const g of around[owner[faces[3 * f + c]]]) if (dot(f, g) > ROUND) for (let k = 0; k < 3; k++) sum[k] += across[3 * g + k] * area[g];
    const size = Math.hypot(...sum) || 1;
    for (let k = 0; k < 3; k++) normal[9 * f + 3 * c + k] = sum[k] / size;
  }
  return { position, normal, edges: edgesOf(faces, owner, vertices, dot) };
}

function edgesOf(faces, owner, vertices, dot) {
  const sides = new Map(), found = [];
  for (let f = 0; f < faces.length / 3; f++) for (let c = 0; c < 3; c++) {
    const a = faces[3 * f + c], b = faces[3 * f + ((c + 1) % 3)], i = owner[a], j = owner[b], name = i < j ? i * 1e7 + j : j * 1e7 + i;
    const other = sides.get(name);
    if (other === undefined) sides.set(name, [f, a, b]);
    else { sides.set(name, null); if (other && dot(f, other[0]) < ROUND) found.push(a, b); }
  }
  for (const left of sides.values()) if (left) found.push(left[1], left[2]);
  return Float32Array.from(found.flatMap((n) => [vertices[3 * n], vertices[3 * n + 1], vertices[3 * n + 2]]));
}

class Drawing {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = (this.gl = canvas.getContext("webgl2", { antialias: true, alpha: false, preserveDrawingBuffer: false }));
    if (!gl) return;
    const [position, normal] = [0, 1];
    this.body = this.program(BODY_VERTEX, BODY_FRAGMENT, { position, normal });
    this.edge = this.program(BODY_VERTEX, EDGE_FRAGMENT, { position, normal });
    this.line = this.program(LINE_VERTEX, LINE_FRAGMENT, { corner: 0, start: 1, end: 2, first: 3, last: 4 });
    this.corners = this.buffer(Float32Array.of(0, -1, 0, 1, 1, -1, 1, 1));
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }
  program(vertex, fragment, places) {
    const gl = this.gl, made = gl.createProgram();
    [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].forEach(([kind, text]) => {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(made, shader);
    });
    Object.entries(places).forEach(([name, place]) => gl.bindAttribLocation(made, place, name));
    gl.linkProgram(made);
    const found = { made };
    for (let n = gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS) - 1; n >= 0; n--) { const { name } = gl.getActiveUniform(made, n); found[name] = gl.getUniformLocation(made, name); }
    return found;
  }
  buffer(values) {
    const gl = this.gl, made = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, made);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    return made;
  }
  attribute(place, buffer, size, kind, step, offset, every) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, kind, kind === gl.UNSIGNED_BYTE, step, offset);
    gl.vertexAttribDivisor(place, every);
  }
  // A form to be drawn in many places.
  shape(vertices, faces) {
    const gl = this.gl, { position, normal, edges } = shaded(vertices, faces), triangles = gl.createVertexArray(), lines = gl.createVertexArray();
    gl.bindVertexArray(triangles);
    this.attribute(0, this.buffer(position), 3, gl.FLOAT, 0, 0, 0);
    this.attribute(1, this.buffer(normal), 3, gl.FLOAT, 0, 0, 0);
    gl.bindVertexArray(lines);
    this.attribute(0, this.buffer(edges), 3, gl.FLOAT, 0, 0, 0);
    gl.bindVertexArray(null);
    return { triangles, count: position.length / 3, lines, edges: edges.length / 3 };
  }
  // Pieces of lines: six numbers and eight bytes of colours (with opacity) a piece.
  pieces(places, colours) {
    const gl = this.gl, array = gl.createVertexArray(), where = this.buffer(Float32Array.from(places)), tints = this.buffer(Uint8Array.from(colours));
    gl.bindVertexArray(array);
    this.attribute(0, this.corners, 2, gl.FLOAT, 0, 0, 0);
    this.attribute(1, where, 3, gl.FLOAT, 24, 0, 1);
    this.attribute(2, where, 3, gl.FLOAT, 24, 12, 1);
    this.attribute(3, tints, 4, gl.UNSIGNED_BYTE, 8, 0, 1);
    this.attribute(4, tints, 4, gl.UNSIGNED_BYTE, 8, 4, 1);
    gl.bindVertexArray(null);
    return { array, count: places.length / 6, owned: [where, tints] };
  }
  begin(camera) {
    const gl = this.gl, canvas = this.canvas, scale = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(Math.round(canvas.clientWidth * scale), 1), height = Math.max(Math.round(canvas.clientHeight * scale), 1);
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    this.scale = scale;
    this.camera = camera.matrix(width / height);
    this.eye = camera.eye();
    this.near = camera.near();
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.945, 0.957, 0.97, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }
  static matrix(a) { return [a[0], a[4], a[8], 0, a[1], a[5], a[9], 0, a[2], a[6], a[10], 0, a[3], a[7], a[11], 1]; }
  // Bodies: { shape, place, colour, alpha, glow, behind: where another one is in the same place }. What is seen through
  // comes last.
  bodies(list) {
    const gl = this.gl;
    [false, true].forEach((through) => {
      const chosen = list.filter((one) => one.alpha < 1 === through);
      if (!chosen.length) return;
      if (through) { gl.enable(gl.BLEND); gl.depthMask(false); }
      gl.enable(gl.POLYGON_OFFSET_FILL);
      this.each(this.body, chosen, (one) => { gl.polygonOffset(1, 1 + (one.behind || 0)); gl.uniform1f(this.body.glow, one.glow || 0); gl.bindVertexArray(one.shape.triangles); gl.drawArrays(gl.TRIANGLES, 0, one.shape.count); });
      gl.disable(gl.POLYGON_OFFSET_FILL);
      this.each(this.edge, chosen, (one) => { if (one.shape.edges) { gl.bindVertexArray(one.shape.lines); gl.drawArrays(gl.LINES, 0, one.shape.edges); } });
      gl.disable(gl.BLEND);
      gl.depthMask(true);
    });
  }
  each(program, list, draw) {
    const gl = this.gl;
    gl.useProgram(program.made);
    gl.uniformMatrix4fv(program.camera, false, this.camera);
    if (program.eye) gl.uniform3fv(program.eye, this.eye);
    list.forEach((one) => {
      gl.uniformMatrix4fv(program.place, false, Drawing.matrix(one.place));
      gl.uniform4f(program.colour, one.colour[0], one.colour[1], one.colour[2], one.alpha);
      draw(one);
    });
  }
  // Lines: { pieces, place, width (of the screen's points), alpha, onTop, from, count }.
  lines(list) {
    const gl = this.gl, program = this.line;
    gl.useProgram(program.made);
    gl.enable(gl.BLEND);
    gl.uniformMatrix4fv(program.camera, false, this.camera);
    gl.uniform2f(program.size, this.canvas.width, this.canvas.height);
    gl.uniform1f(program.near, this.near);
    list.forEach((one) => {
      if (!one.pieces.count) return;
      gl.uniformMatrix4fv(program.place, false, Drawing.matrix(one.place || Pose.one()));
      gl.uniform1f(program.width, one.width * this.scale);
      gl.uniform1f(program.alpha, one.alpha === undefined ? 1 : one.alpha);
      gl.uniform1f(program.nearer, one.flat ? 0 : 2e-5);
      if (one.onTop) gl.disable(gl.DEPTH_TEST);
      gl.bindVertexArray(one.pieces.array);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, one.pieces.count);
      if (one.onTop) gl.enable(gl.DEPTH_TEST);
    });
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
  }
}
