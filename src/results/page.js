// The scene of a report: bodies of links in the plane over time, drawn to scale; and the time cursors of the figures.
"use strict";
(function () {
  const source = document.getElementById("scene-data");
  if (!source) return;
  const scene = JSON.parse(source.textContent), stage = document.getElementById("stage");
  const at = id => document.getElementById("scene-" + id);
  const play = at("play"), scrub = at("scrub"), speed = at("speed"), clock = at("clock"), follow = at("follow");
  const told = at("told"), times = scene.t, last = times.length - 1, end = times[last];
  const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;

  function make(name, attributes, parent) {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const key in attributes) element.setAttribute(key, attributes[key]);
    if (parent) parent.appendChild(element);
    return element;
  }

  // ---- What is seen: metres, y up ---------------------------------------------------------------------------------

  const bounds = (function () {
    let x0 = Infinity, x1 = -Infinity, y0 = Infinity, y1 = -Infinity, reach = 0;
    const see = (x, y) => { x0 = Math.min(x0, x); x1 = Math.max(x1, x); y0 = Math.min(y0, y); y1 = Math.max(y1, y); };
    for (const body of scene.bodies) {
      reach = Math.max(reach, body.length, body.width);
      for (const frame of body.at) for (let i = 0; i < frame.length; i += 3) see(frame[i], frame[i + 1]);
    }
    for (const [x, y] of scene.asked || []) see(x, y);
    const margin = (scene.bodies.some(b => b.force) ? 5 : 3) * reach; // the lines of forces are some two links long
    return { x: (x0 + x1) / 2, y: (y0 + y1) / 2, w: x1 - x0 + margin, h: y1 - y0 + margin };
  })();
  const longestBody = Math.max(...scene.bodies.map(body => body.length * body.at[0].length / 3));
  const apart = scene.bodies.length > 1 ? Math.abs(scene.bodies[1].at[0][1] - scene.bodies[0].at[0][1]) : 0;

  // By the width of the stage: all of it, and the view that follows, some two lengths of a body.
  let narrow, whole, near, chosen = false;
  function measure() {
    narrow = stage.clientWidth > 0 && stage.clientWidth < 500; // a phone
    const flattest = narrow ? 1.6 : 3, tallest = 0.8;
    const w = Math.max(bounds.w, bounds.h / tallest), h = Math.max(bounds.h, w / flattest);
    whole = { x: bounds.x, y: bounds.y, w, h };
    const close = Math.min(w, 1.9 * longestBody + apart);
    near = { w: close, h: close * (narrow ? 0.75 : Math.min(0.6, h / w * 1.6)) };
    const small = longestBody < (narrow ? 0.5 : 0.12) * w; // to be seen in all of it
    if (!chosen) follow.checked = small && close < w;
  }

  const picture = make("svg", { role: "img", "aria-label": scene.title, focusable: "false" });
  const ground = make("g", {}, picture), asked = make("g", {}, picture);
  const robots = make("g", {}, picture), water = make("g", {}, picture), notes = make("g", {}, picture);
  stage.textContent = "";
  stage.appendChild(picture);

  const line = (points, attributes, parent) =>
    make("polyline", Object.assign({ points: points.map(p => p[0] + "," + -p[1]).join(" ") }, attributes), parent);

  // All of it, small, in a corner of the view that follows.
  const map = make("svg", { class: "map", "aria-hidden": "true", preserveAspectRatio: "xMaxYMin" }, picture);
  const sheet = make("rect", { class: "sheet" }, map);

  const thread = (name, width) => ({ class: name, "vector-effect": "non-scaling-stroke", "stroke-width": width });
  if (scene.asked) for (const part of [asked, map]) line(scene.asked, thread("asked", 2), part);

  const bodies = scene.bodies.map((body, k) => {
    const group = make("g", { class: "body" + body.colour }, robots), links = [], joints = [], forces = [];
    const trace = make("polyline", thread("trace", 1.5), group);
    for (let i = 0; i < body.at[0].length / 3; i++)
      links.push(make("line", { "stroke-width": body.width, "stroke-linecap": "round" }, group));
    const far = make("polyline", thread("trace body" + body.colour, 1.5), map);
    const all = make("polyline", thread("all body" + body.colour, 1), map);
    const dot = make("line", Object.assign(thread("body" + body.colour, 7), { "stroke-linecap": "round" }), map);
    const eye = make("circle", { class: "eye", r: body.width * 0.14 }, group);
    if (body.effort)
      for (let i = 0; i < body.effort[0].length; i++)
        joints.push(make("circle", { r: body.width * 0.3, stroke: "none" }, group));
    if (body.force)
      for (let i = 0; i < links.length; i++)
        forces.push(make("line", { class: "force", "stroke-width": body.width * 0.09 }, group));
    let most = 0, strongest = 0;
    const settled = rows => rows.slice(rows.length >> 1); // the first push from rest would dwarf all else
    if (body.effort) for (const f of settled(body.effort)) for (const u of f) most = Math.max(most, Math.abs(u));
    if (body.force) for (const f of settled(body.force)) for (const u of f) strongest = Math.max(strongest, Math.abs(u));
    const middle = body.at.map(f => {
      let x = 0, y = 0;
      for (let i = 0; i < f.length; i += 3) { x += f[i]; y += f[i + 1]; }
      return [3 * x / f.length, 3 * y / f.length];
    });
    all.setAttribute("points", middle.map(m => m[0] + "," + -m[1]).join(" "));
    return { body, links, joints, forces, trace, far, dot, eye, middle, most, strongest };
  });
  const most = Math.max(...bodies.map(b => b.most)), strongest = Math.max(...bodies.map(b => b.strongest));
  const longest = Math.max(...scene.bodies.map(b => b.length)) * 2.2;

  // ---- One moment -------------------------------------------------------------------------------------------------

  let time = 0, running = false, before = 0, rate = 1;

  function place(t) { // frames around t, and how far between them
    let low = 0, high = last;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= t) low = middle; else high = middle;
    }
    const span = times[high] - times[low];
    return { low, high, part: span > 0 ? Math.min(1, Math.max(0, (t - times[low]) / span)) : 0 };
  }
  const mix = (rows, p, i) => rows[p.low][i] + p.part * (rows[p.high][i] - rows[p.low][i]);

  function tint(share) {
    const name = share > 0 ? "--warm" : "--cool";
    return "color-mix(in srgb, var(" + name + ") " + Math.round(100 * Math.min(1, Math.abs(share))) + "%, var(--none))";
  }

  function drawBody(b, p) {
    b.links.forEach((link, i) => {
      const length = b.body.lengths ? b.body.lengths[i] : b.body.length, half = length / 2;
      const x = mix(b.body.at, p, 3 * i), y = mix(b.body.at, p, 3 * i + 1), angle = mix(b.body.at, p, 3 * i + 2);
      const c = half * Math.cos(angle), s = half * Math.sin(angle);
      const inner = Math.max(0, 1 - b.body.width / length); // the round ends are part of the link
      link.setAttribute("x1", x - inner * c); link.setAttribute("y1", -(y - inner * s));
      link.setAttribute("x2", x + inner * c); link.setAttribute("y2", -(y + inner * s));
      if (i === b.links.length - 1) { b.eye.setAttribute("cx", x + 0.6 * c); b.eye.setAttribute("cy", -(y + 0.6 * s)); }
      if (b.forces[i]) {
        const fx = mix(b.body.force, p, 2 * i), fy = mix(b.body.force, p, 2 * i + 1);
        const scale = longest / Math.max(strongest, Math.hypot(fx, fy));
        b.forces[i].setAttribute("x1", x); b.forces[i].setAttribute("y1", -y);
        b.forces[i].setAttribute("x2", x + scale * fx);
        b.forces[i].setAttribute("y2", -(y + scale * fy));
      }
      if (b.joints[i]) {
        const next = 3 * (i + 1), a = mix(b.body.at, p, next + 2);
        const jx = (x + c + mix(b.body.at, p, next) - half * Math.cos(a)) / 2;
        const jy = (y + s + mix(b.body.at, p, next + 1) - half * Math.sin(a)) / 2;
        b.joints[i].setAttribute("cx", jx); b.joints[i].setAttribute("cy", -jy);
        b.joints[i].style.fill = tint(mix(b.body.effort, p, i) / most);
      }
    });
    const points = b.middle.slice(0, p.low + 1).map(m => m[0] + "," + -m[1]);
    for (const trace of [b.trace, b.far]) trace.setAttribute("points", points.join(" "));
    const [x, y] = b.middle[p.low]; // a line of no length with round ends
    for (const [name, value] of [["x1", x], ["x2", x], ["y1", -y], ["y2", -y]]) b.dot.setAttribute(name, value);
  }

  function view(p) { // as wide as the stage, which is no taller than three quarters of the window
    const v = centre(p), tallest = 0.75 * innerHeight, width = stage.clientWidth;
    return width > 0 ? { x: v.x, y: v.y, w: Math.max(v.w, v.h * width / tallest), h: v.h } : v;
  }
  function centre(p) {
    if (!follow.checked) return whole;
    let x = 0, y = 0;
    for (const b of bodies) {
      x += b.middle[p.low][0] + p.part * (b.middle[p.high][0] - b.middle[p.low][0]);
      y += b.middle[p.low][1] + p.part * (b.middle[p.high][1] - b.middle[p.low][1]);
    }
    return { x: x / bodies.length, y: y / bodies.length, w: near.w, h: near.h };
  }

  function placeMap(v) {
    const share = Math.min(narrow ? 0.35 : 0.24, 0.35 * v.h * whole.w / whole.h / v.w);
    const w = share * v.w, h = w * whole.h / whole.w, gap = 0.012 * v.w, shown = follow.checked && whole.w > 1.5 * v.w;
    const set = (element, x, y, width, height) => {
      for (const [name, value] of Object.entries({ x, y, width, height })) element.setAttribute(name, value);
    };
    const x0 = whole.x - whole.w / 2, y0 = -whole.y - whole.h / 2;
    map.setAttribute("visibility", shown ? "visible" : "hidden");
    map.setAttribute("viewBox", [x0, y0, whole.w, whole.h].join(" "));
    set(map, v.x + v.w / 2 - w - gap, -v.y - v.h / 2 + gap, w, h);
    set(sheet, x0, y0, whole.w, whole.h);
  }

  function drawGround(v, t) {
    const width = stage.clientWidth || 700;
    const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50].find(s => s * width / v.w > 55) || 100;
    const size = v.w * 12 / width, x0 = v.x - v.w / 2, x1 = v.x + v.w / 2, y0 = v.y - v.h / 2, y1 = v.y + v.h / 2;
    ground.textContent = notes.textContent = "";
    const thin = thread("grid", 1);
    const label = (x, y, text, anchor) =>
      make("text", { x, y, "font-size": size, "text-anchor": anchor }, notes).textContent = text;
    const digits = step < 1 ? 1 : 0;
    for (let x = Math.ceil(x0 / step) * step; x <= x1; x += step) {
      line([[x, y0], [x, y1]], thin, ground);
      if (x > x0 + 3 * size && x < x1 - 3 * size) label(x, -y0 - 0.4 * size, x.toFixed(digits) + " m", "middle");
    }
    for (let y = Math.ceil(y0 / step) * step; y <= y1; y += step) line([[x0, y], [x1, y]], thin, ground);
    const [cx, cy] = scene.current, flow = Math.hypot(cx, cy);
    water.textContent = "";
    if (flow > 0) { // arrows that drift with the water
      const lattice = step * width / v.w > 90 ? step : 2 * step, arrow = Math.min(0.35 * step, 0.025 * v.w);
      const ux = cx / flow, uy = cy / flow;
      const start = (from, drift) => Math.ceil((from - drift) / lattice) * lattice + drift;
      for (let x = start(x0, cx * t); x <= x1; x += lattice)
        for (let y = start(y0, cy * t); y <= y1; y += lattice) {
          const hx = x + arrow * ux, hy = y + arrow * uy, b = 0.3 * arrow;
          make("path", { class: "current", "vector-effect": "non-scaling-stroke", "stroke-width": 1.5,
            d: `M${x - arrow * ux},${-(y - arrow * uy)}L${hx},${-hy}M${hx - b * (ux - uy)},${-(hy - b * (uy + ux))}` +
               `L${hx},${-hy}L${hx - b * (ux + uy)},${-(hy - b * (uy - ux))}` }, ground);
        }
    }
  }

  function tell(p) {
    const parts = bodies.map(b => {
      const m = b.middle, x = m[p.low][0] + p.part * (m[p.high][0] - m[p.low][0]);
      const y = m[p.low][1] + p.part * (m[p.high][1] - m[p.low][1]);
      return b.body.name + ": " + Math.hypot(x - m[0][0], y - m[0][1]).toFixed(2) + " m from its start";
    });
    for (const c of scene.channels || [])
      parts.push(c.name + ": " + (c.values[p.low] + p.part * (c.values[p.high] - c.values[p.low])).toPrecision(3) +
        (c.unit ? " " + c.unit : ""));
    told.textContent = parts.join("; ");
  }

  function moveCursors(t) {
    for (const figure of document.querySelectorAll("svg[data-time]")) {
      const [t0, t1, x0, x1, y0, y1] = figure.dataset.time.split(" ").map(Number);
      let cursor = figure.querySelector(".cursor");
      if (!cursor) cursor = make("line", { class: "cursor", y1: y0, y2: y1 }, figure);
      const inside = t >= t0 && t <= t1, x = x0 + (x1 - x0) * (t - t0) / (t1 - t0);
      cursor.setAttribute("visibility", inside ? "visible" : "hidden");
      cursor.setAttribute("x1", x); cursor.setAttribute("x2", x);
    }
  }

  function show(t) {
    time = Math.min(end, Math.max(times[0], t));
    const p = place(time), v = view(p);
    picture.setAttribute("viewBox", [v.x - v.w / 2, -v.y - v.h / 2, v.w, v.h].join(" "));
    drawGround(v, time);
    placeMap(v);
    for (const b of bodies) drawBody(b, p);
    clock.textContent = time.toFixed(2) + " of " + end.toFixed(0) + " s";
    scrub.value = time;
    scrub.setAttribute("aria-valuetext", time.toFixed(2) + " seconds");
    stage.dataset.time = time.toFixed(3);
    tell(p);
    moveCursors(time);
  }

  // ---- Control ----------------------------------------------------------------------------------------------------

  function run(on) {
    running = on;
    if (on && time >= end) time = times[0];
    play.textContent = on ? "Pause" : "Play";
    before = 0;
    if (on) requestAnimationFrame(tick);
  }
  function tick(now) {
    if (!running) return;
    if (before) show(time + rate * Math.min(0.1, (now - before) / 1000));
    before = now;
    if (time >= end) run(false); else requestAnimationFrame(tick);
  }
  function step(frames) {
    run(false);
    const p = place(time);
    show(times[Math.min(last, Math.max(0, (p.part > 0.5 ? p.high : p.low) + frames))]);
  }
  function hurry(by) {
    speed.selectedIndex = Math.min(speed.options.length - 1, Math.max(0, speed.selectedIndex + by));
    rate = Number(speed.value);
  }

  play.addEventListener("click", () => run(!running));
  at("back").addEventListener("click", () => step(-1));
  at("on").addEventListener("click", () => step(1));
  speed.addEventListener("change", () => { rate = Number(speed.value); });
  follow.addEventListener("change", () => { chosen = true; show(time); });
  scrub.addEventListener("input", () => { run(false); show(Number(scrub.value)); });
  addEventListener("resize", () => { measure(); show(time); });
  // Only where the scene has the focus: elsewhere the page is scrolled by the same keys.
  document.getElementById("scene").addEventListener("keydown", event => {
    const own = event.target.closest && event.target.closest("input, select, button, a, summary, .scroll");
    if (own || event.ctrlKey || event.altKey || event.metaKey) return;
    const keys = { " ": () => run(!running), k: () => run(!running), ArrowRight: () => step(1), ArrowLeft: () => step(-1),
      Home: () => { run(false); show(times[0]); }, End: () => { run(false); show(end); },
      "+": () => hurry(1), "-": () => hurry(-1),
      f: () => { chosen = true; follow.checked = !follow.checked; show(time); } };
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  });

  scrub.min = times[0]; scrub.max = end; scrub.step = "any";
  document.getElementById("scene").hidden = false;
  measure();
  const moment = /^#t=([0-9.]+)$/.exec(location.hash); // report.html#t=6: at rest at that moment
  show(moment ? Number(moment[1]) : times[0]);
  addEventListener("beforeprint", () => { run(false); show(end / 2); });
  if (!calm && !moment) run(true);
})();
