"use strict";
// Draws the plots of the page in the colours of its style sheet, and lets a picker show one panel of a group at a time.
(function () {
  const figures = JSON.parse(document.getElementById("figures").textContent);
  const root = document.documentElement;
  const config = {
    responsive: true, displayModeBar: false, typesetMath: false, plotlyServerURL: "",
  };

  function colour(name) {
    return getComputedStyle(root).getPropertyValue(name).trim();
  }

  // Figures name colours by role, "var(--measured)"; plotly.js needs their values.
  function coloured(node) {
    if (typeof node === "string") {
      const role = /^var\((--[a-z0-9-]+)\)$/.exec(node);
      return role ? colour(role[1]) : node;
    }
    if (Array.isArray(node)) return node.map(coloured);
    if (node === null || typeof node !== "object") return node;
    return Object.fromEntries(Object.entries(node).map(([key, value]) => [key, coloured(value)]));
  }

  // A trace that shares the x of the one before it says so instead of holding it again.
  function completed(traces) {
    traces.forEach((trace, index) => { if (trace.x === "same x") trace.x = traces[index - 1].x; });
    return traces;
  }

  function merged(base, own) {
    const result = { ...base };
    for (const [key, value] of Object.entries(own)) {
      const deep = value && base[key] && typeof value === "object" && !Array.isArray(value);
      result[key] = deep ? merged(base[key], value) : value;
    }
    return result;
  }

  function axis() {
    return {
      automargin: true, gridcolor: colour("--grid"), linecolor: colour("--line"), zerolinecolor: colour("--line"),
      title: { standoff: 8 },
    };
  }

  function layout(own) {
    const base = {
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
      font: { family: getComputedStyle(document.body).fontFamily, size: 13, color: colour("--ink") },
      margin: { l: 56, r: 12, t: 28, b: 48 },
      legend: { orientation: "h", x: 0, y: 1.02, yanchor: "bottom" },
      hoverlabel: { namelength: -1 },
      xaxis: axis(), yaxis: axis(),
    };
    for (const key of Object.keys(own)) if (/^[xy]axis\d+$/.test(key)) base[key] = axis();
    return merged(base, coloured(own));
  }

  function draw(place) {
    const figure = figures[place.dataset.figure];
    if (!figure || place.closest("[hidden]") || place.offsetWidth === 0) return;
    const traces = completed(coloured(figure.data));
    const form = layout(figure.layout);
    if (root.dataset.print) form.width = place.offsetWidth;
    if (place.dataset.drawn) Plotly.react(place, traces, form, config);
    else Plotly.newPlot(place, traces, form, config);
    place.dataset.drawn = "yes";
  }

  function drawAll(within) {
    within.querySelectorAll("[data-figure]").forEach(draw);
  }

  // A picker's buttons name the panels they show: data-group is the group, data-show one panel's key or "*" for all.
  function show(group, key) {
    document.querySelectorAll(`.panel[data-group="${group}"]`).forEach((panel) => {
      panel.hidden = key !== "*" && panel.dataset.panel !== key;
      if (!panel.hidden) drawAll(panel);
    });
    document.querySelectorAll(`[data-show][data-group="${group}"]`).forEach((button) => {
      button.setAttribute("aria-pressed", String(button.dataset.show === key));
    });
  }

  document.querySelectorAll("[data-show]").forEach((button) => {
    const choose = () => show(button.dataset.group, button.dataset.show);
    button.addEventListener("click", choose);
    if (button.getAttribute("aria-pressed") === "true") choose();
  });

  drawAll(document);
  document.querySelectorAll("details").forEach((fold) => fold.addEventListener("toggle", () => drawAll(fold)));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => drawAll(document));

  // On paper every panel is shown, in the light colours.
  const hiddenForScreen = new Set();
  addEventListener("beforeprint", () => {
    root.dataset.print = "yes";
    document.querySelectorAll(".panel[hidden]").forEach((panel) => { hiddenForScreen.add(panel); panel.hidden = false; });
    document.querySelectorAll("details:not([open])").forEach((fold) => { hiddenForScreen.add(fold); fold.open = true; });
    drawAll(document);
  });
  addEventListener("afterprint", () => {
    delete root.dataset.print;
    hiddenForScreen.forEach((node) => { if (node.tagName === "DETAILS") node.open = false; else node.hidden = true; });
    hiddenForScreen.clear();
    drawAll(document);
  });
})();
