"use strict";
// A small arm of capsules that plays a held-out motion beside what is missing at every joint, with one time cursor.
(function () {
  const place = document.getElementById("arm-view");
  if (!place) return;
  const data = JSON.parse(document.getElementById("arm-view-data").textContent);
  const style = getComputedStyle(document.documentElement);
  const ink = (name) => style.getPropertyValue(name).trim();
  const arm = place.querySelector("canvas.arm"), lanes = place.querySelector("canvas.lanes");
  const slider = place.querySelector("input"), play = place.querySelector("button.play"), clock = place.querySelector("output");
  const sides = [...place.querySelectorAll("button[data-side]")];
  const n = data.joints.length, frames = data.frames, reduced = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const angles = whole(data.angles, Int16Array), missing = { before: whole(data.before, Uint8Array), after: whole(data.after, Uint8Array) };
  const RAMP = [[157, 184, 176], [255, 255, 178], [253, 141, 60], [165, 0, 38]];
  const view = { azimuth: data.azimuth, elevation: 0.35, side: "before", time: 0, playing: false, last: 0 };

  function whole(text, kind) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new kind(bytes.buffer);
  }

  function multiplied(a, b) {
    const out = new Array(9).fill(0);
    for (let i = 0; i < 3; i++) for (let j = 0; j < 3; j++) for (let k = 0; k < 3; k++) out[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    return out;
  }

  function turned(m, v) {
    return [0, 1, 2].map((i) => m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2]);
  }

  function about([x, y, z], angle) {
    const c = Math.cos(angle), s = Math.sin(angle), d = 1 - c;
    return [c + x * x * d, x * y * d - z * s, x * z * d + y * s, y * x * d + z * s, c + y * y * d, y * z * d - x * s,
      z * x * d - y * s, z * y * d + x * s, c + z * z * d];
  }

  // Points of base, joints and tip for the joint positions of a frame.
  function posed(frame) {
    const frames_ = [], points = [[0, 0, 0]];
    data.tree.forEach((body, j) => {
      const up = body.parent < 0 ? { p: [0, 0, 0], r: [1, 0, 0, 0, 1, 0, 0, 0, 1] } : frames_[body.parent];
      const q = angles[frame * n + j] * data.step[j] + data.middle[j];
      const r = multiplied(up.r, body.rotation), p = turned(up.r, body.position).map((x, i) => x + up.p[i]);
      const slid = body.slides ? turned(r, body.axis).map((x, i) => p[i] + q * x) : p;
      frames_.push({ p: slid, r: body.slides ? r : multiplied(r, about(body.axis, q)) });
      points.push(slid);
    });
    const last = frames_[n - 1];
    points.push(turned(last.r, data.tip).map((x, i) => x + last.p[i]));
    return points;
  }

  function fitted(canvas) {
    const scale = Math.min(devicePixelRatio || 1, 2), width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * scale)) { canvas.width = Math.round(width * scale); canvas.height = Math.round(height * scale); }
    const pen = canvas.getContext("2d");
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    pen.clearRect(0, 0, width, height);
    return [pen, width, height];
  }

  function shade(value) {
    const at = Math.min(value / 255, 1) * (RAMP.length - 1), k = Math.min(Math.floor(at), RAMP.length - 2);
    return `rgb(${RAMP[k].map((c, i) => Math.round(c + (RAMP[k + 1][i] - c) * (at - k))).join(",")})`;
  }

  function projector(width, height) {
    const ca = Math.cos(view.azimuth), sa = Math.sin(view.azimuth), ce = Math.cos(view.elevation), se = Math.sin(view.elevation);
    const scale = 0.46 * Math.min(width, height) / data.reach, [cx, cy, cz] = data.centre;
    return ([x, y, z]) => {
      const a = (x - cx) * ca + (y - cy) * sa, b = -(x - cx) * sa + (y - cy) * ca, c = z - cz;
      return { x: width / 2 + scale * a, y: height / 2 - scale * (c * ce + b * se), depth: b * ce - c * se, scale };
    };
  }

  function drawArm(frame) {
    const [pen, width, height] = fitted(arm), project = projector(width, height);
    pen.lineCap = "round";
    pen.lineWidth = 1;
    pen.strokeStyle = ink("--grid");
    for (let k = -4; k <= 4; k++) {
      const far = data.reach, at = (k / 4) * far, [bx, by] = data.centre;
      for (const [a, b] of [[[bx + at, by - far, 0], [bx + at, by + far, 0]], [[bx - far, by + at, 0], [bx + far, by + at, 0]]]) {
        const p = project(a), q = project(b);
        pen.beginPath(); pen.moveTo(p.x, p.y); pen.lineTo(q.x, q.y); pen.stroke();
      }
    }
    const points = posed(frame).map(project), parts = [];
    const thick = Math.max(7, 0.085 * data.reach * points[0].scale);
    const ends = data.tree.map((body, j) => [body.parent + 1, j + 1]).concat([[n, n + 1]]);
    ends.forEach(([a, b], k) => parts.push({ depth: Math.max(points[a].depth, points[b].depth) + 1e-6, draw() {
      const w = thick * (1 - 0.5 * k / ends.length);
      for (const [extra, colour, lift] of [[2, ink("--quiet"), 0], [0, ink("--line"), 0], [-0.62 * w, ink("--panel"), -0.16 * w]]) {
        pen.lineWidth = w + extra; pen.strokeStyle = colour;
        pen.beginPath(); pen.moveTo(points[a].x, points[a].y + lift); pen.lineTo(points[b].x, points[b].y + lift); pen.stroke();
      }
    } }));
    data.tree.forEach((_, j) => parts.push({ depth: points[j + 1].depth - 1e-3 * data.reach, draw() {
      const { x, y } = points[j + 1], r = thick * (0.62 - 0.2 * j / n), colour = shade(missing[view.side][frame * n + j]);
      pen.beginPath(); pen.arc(x, y, r, 0, 2 * Math.PI); pen.fillStyle = colour; pen.fill();
      pen.lineWidth = 1.2; pen.strokeStyle = ink("--ink"); pen.stroke();
    } }));
    parts.sort((a, b) => b.depth - a.depth).forEach((part) => part.draw());
  }

  function drawLanes(frame) {
    const [pen, width, height] = fitted(lanes), left = 8, lane = (height - 18) / n, wide = width - left - 8;
    const x = (k) => left + wide * k / Math.max(frames - 1, 1);
    pen.font = "12px " + getComputedStyle(document.body).fontFamily;
    data.joints.forEach((name, j) => {
      const floor = (j + 1) * lane - 2, tall = lane - 16;
      pen.strokeStyle = ink("--grid"); pen.lineWidth = 1;
      pen.beginPath(); pen.moveTo(left, floor); pen.lineTo(left + wide, floor); pen.stroke();
      for (const side of ["before", "after"]) {
        pen.strokeStyle = ink(side === "before" ? "--nominal" : "--corrected");
        pen.globalAlpha = side === view.side ? 1 : 0.35; pen.lineWidth = side === view.side ? 1.6 : 1;
        pen.beginPath();
        for (let k = 0; k < frames; k++) pen.lineTo(x(k), floor - tall * missing[side][k * n + j] / 255);
        pen.stroke();
      }
      pen.globalAlpha = 1; pen.fillStyle = ink("--ink");
      pen.fillText(name, left + 2, j * lane + 11);
    });
    pen.strokeStyle = ink("--ink"); pen.lineWidth = 1.5;
    pen.beginPath(); pen.moveTo(x(frame), 0); pen.lineTo(x(frame), height - 16); pen.stroke();
    pen.fillStyle = ink("--quiet");
    pen.fillText("0 s", left, height - 3);
    const end = `${data.seconds.toFixed(1)} s`;
    pen.fillText(end, left + wide - pen.measureText(end).width, height - 3);
  }

  function draw() {
    if (!place.offsetWidth) return;
    const frame = Math.min(frames - 1, Math.max(0, Math.round(view.time / data.seconds * (frames - 1))));
    drawArm(frame); drawLanes(frame);
    slider.value = String(frame);
    clock.textContent = `${view.time.toFixed(2)} s`;
    place.dataset.frame = String(frame);
  }

  function tick(now) {
    if (!view.playing) return;
    view.time = (view.time + Math.min((now - view.last) / 1000, 0.2)) % data.seconds;
    view.last = now;
    draw();
    requestAnimationFrame(tick);
  }

  function toggle(on) {
    view.playing = on; view.last = performance.now();
    play.textContent = on ? "Pause" : "Play"; play.setAttribute("aria-pressed", String(on));
    if (on) requestAnimationFrame(tick);
  }

  play.addEventListener("click", () => toggle(!view.playing));
  slider.addEventListener("input", () => { toggle(false); view.time = slider.value / Math.max(frames - 1, 1) * data.seconds; draw(); });
  sides.forEach((button) => button.addEventListener("click", () => {
    view.side = button.dataset.side;
    sides.forEach((b) => b.setAttribute("aria-pressed", String(b === button)));
    draw();
  }));
  let held = null;
  arm.addEventListener("pointerdown", (e) => { held = [e.clientX, e.clientY]; arm.setPointerCapture(e.pointerId); });
  arm.addEventListener("pointermove", (e) => {
    if (!held) return;
    view.azimuth -= (e.clientX - held[0]) * 0.01;
    view.elevation = Math.max(-1.5, Math.min(1.5, view.elevation + (e.clientY - held[1]) * 0.01));
    held = [e.clientX, e.clientY];
    draw();
  });
  arm.addEventListener("pointerup", () => { held = null; });
  lanes.addEventListener("pointerdown", (e) => {
    const box = lanes.getBoundingClientRect();
    toggle(false); view.time = Math.max(0, Math.min(1, (e.clientX - box.left - 8) / (box.width - 16))) * data.seconds; draw();
  });
  addEventListener("resize", draw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  draw();
  if (!reduced && location.hash === "#arm_view") toggle(true);
})();
