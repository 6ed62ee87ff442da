"use strict";
// Tables that filter and sort, and the timeline of the robot that is chosen, from the data of the page.
(function () {
  const fleet = JSON.parse(document.getElementById("fleet").textContent);
  const PAGE = 50, WIDTH = 520, HEIGHT = 190, LEFT = 64, RIGHT = 10, TOP = 8, BOTTOM = 24, DAY = 86400000;
  const SVG = "http://www.w3.org/2000/svg";
  const byId = (id) => document.getElementById(id);

  function unpack(text) {
    const raw = atob(text), bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
    return new Float32Array(bytes.buffer);
  }
  function day(days) { // with the time of day, but at midnight, which dates without a time have
    const [date, time] = new Date(Math.round(days * 1440) * 60000).toISOString().slice(0, 16).split("T");
    return time === "00:00" ? date : `${date} ${time}`;
  }
  function digits(value) {
    if (!Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    return (size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(1) : String(Number(value.toPrecision(3)))).replace("-", "−");
  }
  const signed = (value, unit) => (value > 0 ? "+" : "") + digits(value) + (unit && unit !== "–" ? " " + unit : "");
  const told = (event) => event.relative ? signed(Number((100 * event.change).toPrecision(2)), "%") : signed(event.change, event.unit);
  function element(tag, attributes, ...children) {
    const node = document.createElement(tag);
    Object.entries(attributes || {}).forEach(([key, value]) => { if (value !== null && value !== undefined) node.setAttribute(key, value); });
    node.append(...children);
    return node;
  }
  function shape(tag, attributes, text) {
    const node = document.createElementNS(SVG, tag);
    Object.entries(attributes).forEach(([key, value]) => node.setAttribute(key, value));
    if (text !== undefined) node.textContent = text;
    return node;
  }

  // One row a robot, with what its cells say worked out once.
  const places = Math.max(1, ...fleet.robots.map((robot) => robot.joints.length));
  const same = fleet.robots.every((robot) => robot.joints.join() === fleet.robots[0].joints.join());
  const rows = fleet.robots.map((robot, index) => {
    const days = unpack(robot.days), failed = Object.keys(robot.errors).length;
    return {
      index, robot, failed, events: [], last: days.length ? robot.start + days[days.length - 1] : 0, cells: [],
      recent: false, odd: robot.series.some((series) => series.odd),
      text: [robot.name, robot.make, ...robot.joints].join(" ").toLowerCase(),
    };
  });
  fleet.events.forEach((event) => { const row = rows[event.robot]; row.events.push(event); row.recent = row.recent || event.recent; });
  const strength = (event) => Math.abs(event.change) / Math.max(Math.abs(event.upper - event.lower), 1e-12);
  rows.forEach((row) => {
    [...row.robot.joints, null].forEach((joint, place) => {
      const events = row.events.filter((event) => event.joint === joint).sort((a, b) => strength(b) - strength(a));
      const odd = row.robot.series.filter((series) => series.joint === joint && series.odd);
      const known = row.robot.series.some((series) => series.joint === joint);
      const at = joint === null ? places : place;
      if (events.length) {
        const words = events.map((event) => `${event.effect} ${event.parameter} ${told(event)} ${event.kind} ${day(event.date)}`).join("; ");
        row.cells[at] = { rank: 3 + strength(events[0]), kind: events.some((event) => event.recent) ? "bad" : "warn", text: `${events[0].parameter} ${told(events[0])}`, words };
      } else if (odd.length) {
        row.cells[at] = { rank: 2, kind: "warn", text: "apart", words: odd.map((series) => `${series.effect} ${series.parameter} is out of family`).join("; ") };
      } else row.cells[at] = known ? { rank: 1, kind: "good", text: "steady", words: "" } : { rank: 0, kind: "quiet", text: "–", words: "nothing is followed here" };
    });
  });

  // A table that sorts by its headings and shows a page at a time.
  function sortable(table, pager, columns, filtered, initial, onChoose) {
    const state = { column: columns.findIndex((column) => column.title === initial), down: true, page: 0 };
    const head = element("tr"), body = element("tbody");
    columns.forEach((column, index) => {
      const button = element("button", { type: "button" }, column.title);
      button.addEventListener("click", () => { state.down = state.column === index ? !state.down : Boolean(column.down); state.column = index; state.page = 0; show(); });
      head.append(element("th", { scope: "col", class: column.number ? "number" : null }, button));
    });
    table.append(element("thead", {}, head), body);
    function show() {
      const { key } = columns[state.column], sign = state.down ? -1 : 1;
      const found = filtered().map((row) => [key(row), row]);
      found.sort(([a], [b]) => sign * (typeof a === "string" ? a.localeCompare(b, undefined, { numeric: true }) : a - b));
      [...head.children].forEach((cell, index) => cell.setAttribute("aria-sort", index !== state.column ? "none" : state.down ? "descending" : "ascending"));
      body.replaceChildren(...found.slice(PAGE * state.page, PAGE * (state.page + 1)).map(([, row]) => {
        const line = element("tr", {}, ...columns.map((column) => element("td", { class: column.number ? "number" : null }, column.cell(row))));
        if (onChoose) line.addEventListener("click", () => onChoose(row));
        return line;
      }));
      const pages = Math.ceil(found.length / PAGE);
      pager.replaceChildren(...(pages < 2 ? [] : Array.from({ length: pages }, (_, page) => {
        const button = element("button", { type: "button", "aria-pressed": String(page === state.page) }, String(page + 1));
        button.addEventListener("click", () => { state.page = page; show(); });
        return button;
      })));
      return found.length;
    }
    return { show, first: () => { state.page = 0; return show(); } };
  }

  const passes = (row) => {
    const words = byId("fleet-filter").value.trim().toLowerCase(), state = byId("fleet-state").value;
    const kinds = { "": true, recent: row.recent, changed: row.events.length > 0, odd: row.odd, failed: row.failed > 0 };
    return kinds[state] && words.split(/\s+/).every((word) => row.text.includes(word));
  };
  const badge = (cell) => element("span", { class: `badge badge-${cell.kind}`, title: cell.words }, cell.text);
  function opener(row) {
    const button = element("button", { type: "button", class: "plain-button" }, row.robot.name);
    button.addEventListener("click", (click) => { click.stopPropagation(); choose(row, true); });
    return button;
  }
  const cellColumn = (place, title) => ({ title, down: true, key: (row) => row.cells[place] ? row.cells[place].rank : -1, cell: (row) => row.cells[place] ? badge(row.cells[place]) : "" });
  const robots = sortable(byId("fleet-robots-table"), byId("fleet-pages"), [
    { title: "robot", key: (row) => row.robot.name, cell: opener },
    { title: "make", key: (row) => row.robot.make, cell: (row) => row.robot.make },
    ...Array.from({ length: places }, (_, place) => cellColumn(place, same ? rows[0].robot.joints[place] : `joint ${place + 1}`)),
    cellColumn(places, "whole arm"),
    { title: "changes", number: true, down: true, key: (row) => row.events.length + 1000 * row.recent + 0.5 * row.odd, cell: (row) => String(row.events.length) },
    { title: "failed", number: true, down: true, key: (row) => row.failed, cell: (row) => String(row.failed) },
    { title: "last recording", down: true, key: (row) => row.last, cell: (row) => day(row.last) },
  ], () => rows.filter(passes), "changes", (row) => choose(row, false));
  const changes = sortable(byId("fleet-changes-table"), byId("changes-pages"), [
    { title: "date", down: true, key: (event) => event.date, cell: (event) => day(event.date) },
    { title: "between", key: (event) => event.earliest, cell: (event) => `${day(event.earliest)} … ${day(event.latest)}` },
    { title: "robot", key: (event) => rows[event.robot].robot.name, cell: (event) => opener(rows[event.robot]) },
    { title: "joint", key: (event) => event.joint || "", cell: (event) => event.joint || "whole arm" },
    { title: "parameter", key: (event) => event.effect + event.parameter, cell: (event) => `${event.effect}, ${event.parameter}` },
    { title: "kind", key: (event) => event.kind, cell: (event) => event.kind },
    { title: "change", number: true, down: true, key: (event) => Math.abs(event.change), cell: told },
    { title: "temperature", key: (event) => String(event.warm), cell: (event) => event.warm ? "taken into account" : "not known" },
  ], () => fleet.events.filter((event) => passes(rows[event.robot])), "date");

  function show() {
    const count = robots.first();
    byId("fleet-count").textContent = `${count} of ${rows.length} robots`;
    changes.first();
  }

  function choose(row, jump) {
    const { robot } = row;
    byId("robot-name").textContent = `${robot.name} (${robot.make})`;
    byId("robot-note").textContent = row.events.length ? row.events.map((event) => `${event.effect} ${event.parameter} at ${event.joint || "the whole arm"} ${told(event)}, ${event.kind}, ${day(event.date)}`).join("; ") : "No change by more than temperature and load explain.";
    const days = unpack(robot.days), temperature = unpack(robot.temperature);
    const plots = robot.series.map((series) => plot(row, series, days));
    if (temperature.some(Number.isFinite)) plots.push(lines(robot, "temperature [°C]", days, temperature));
    byId("robot-plots").replaceChildren(...plots);
    recordings(robot, days, temperature);
    if (jump) byId("fleet_timeline").scrollIntoView();
  }

  function frame(title, robot, days, low, high) {
    const figure = element("figure", { class: "fleet-plot" }, element("figcaption", {}, title));
    const svg = shape("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": title });
    figure.append(svg);
    const first = days.length ? days[0] : 0, span = Math.max(days.length ? days[days.length - 1] - first : 1, 1e-6);
    const pad = 0.08 * (high - low || Math.abs(high) || 1), bottom = low - pad, top = high + pad;
    const x = (value) => LEFT + 6 + (WIDTH - LEFT - RIGHT - 12) * (value - first) / span;
    const y = (value) => TOP + (HEIGHT - TOP - BOTTOM) * (top - value) / (top - bottom);
    for (let k = 0; k <= 3; k++) {
      const value = bottom + (top - bottom) * k / 3;
      svg.append(shape("line", { x1: LEFT, x2: WIDTH - RIGHT, y1: y(value), y2: y(value), class: "fleet-grid" }), shape("text", { x: LEFT - 6, y: y(value) + 4, "text-anchor": "end" }, digits(value)));
    }
    [[0, "start"], [span, "end"]].forEach(([at, anchor]) => svg.append(shape("text", { x: x(first + at), y: HEIGHT - 6, "text-anchor": anchor }, day(robot.start + first + at))));
    return { figure, svg, x, y };
  }

  function plot(row, series, days) {
    const { robot } = row, at = unpack(series.at), value = unpack(series.value), lower = unpack(series.lower), upper = unpack(series.upper), adjusted = unpack(series.adjusted);
    const seen = [...lower, ...upper, ...adjusted].filter(Number.isFinite);
    const unit = series.unit && series.unit !== "–" ? ` [${series.unit}]` : " [–]";
    const { figure, svg, x, y } = frame(`${series.effect}, ${series.parameter}${unit} at ${series.joint || "the whole arm"}${series.odd ? " – out of family" : ""}`, robot, days, Math.min(...seen), Math.max(...seen));
    if (series.family) {
      const edges = series.family.map(y).sort((a, b) => a - b).map((edge) => Math.min(Math.max(edge, TOP), HEIGHT - BOTTOM));
      svg.append(shape("rect", { x: LEFT, width: WIDTH - LEFT - RIGHT, y: edges[0], height: edges[1] - edges[0], class: "fleet-family" }));
    }
    row.events.filter((event) => event.joint === series.joint && event.effect === series.effect && event.parameter === series.parameter).forEach((event) => {
      const place = x(event.date - robot.start);
      svg.append(shape("line", { x1: place, x2: place, y1: TOP, y2: HEIGHT - BOTTOM, class: "fleet-event" }));
    });
    const path = Array.from(at, (index, i) => [days[index], adjusted[i]]).filter(([, v]) => Number.isFinite(v));
    svg.append(shape("polyline", { points: path.map(([d, v]) => `${x(d).toFixed(1)},${y(v).toFixed(1)}`).join(" "), class: "fleet-line" }));
    at.forEach((index, i) => {
      const link = shape("a", robot.pages[index] ? { href: encodeURI(robot.pages[index]) } : {});
      const place = x(days[index]);
      link.append(shape("line", { x1: place, x2: place, y1: y(lower[i]), y2: y(upper[i]), class: "fleet-bar" }), shape("circle", { cx: place, cy: y(value[i]), r: 3.5, class: "fleet-point" }));
      link.append(shape("title", {}, `${day(robot.start + days[index])}: ${digits(value[i])} (${digits(lower[i])} … ${digits(upper[i])})`));
      svg.append(link);
    });
    return figure;
  }

  function lines(robot, title, days, values) {
    const seen = [...values].filter(Number.isFinite);
    const { figure, svg, x, y } = frame(title, robot, days, Math.min(...seen), Math.max(...seen));
    svg.append(shape("polyline", { points: [...values].map((v, i) => [v, i]).filter(([v]) => Number.isFinite(v)).map(([v, i]) => `${x(days[i]).toFixed(1)},${y(v).toFixed(1)}`).join(" "), class: "fleet-line" }));
    return figure;
  }

  function recordings(robot, days, temperature) {
    const head = element("thead", {}, element("tr", {}, ...["date", "recording", "temperature [°C]", "diagnosis"].map((title) => element("th", { scope: "col" }, title))));
    const body = element("tbody", {}, ...robot.recordings.map((name, i) => element("tr", {},
      element("td", {}, day(robot.start + days[i])), element("td", { class: "wide" }, name), element("td", { class: "number" }, digits(temperature[i])),
      element("td", {}, robot.pages[i] ? element("a", { href: encodeURI(robot.pages[i]) }, "open") : robot.errors[String(i)] || "–"))));
    byId("robot-recordings").replaceChildren(head, body);
  }

  byId("fleet-filter").addEventListener("input", show);
  byId("fleet-state").addEventListener("change", show);
  show();
  const first = rows.find((row) => row.recent) || rows.find((row) => row.events.length) || rows[0];
  if (first) choose(first, false);
})();
