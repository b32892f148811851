// Draws the plots when they come into sight, and lets the controls choose what the first one shows.
"use strict";
const plots = JSON.parse(document.getElementById("plots").textContent);
const text = { labelColor: "var(--ink)", titleColor: "var(--ink)", labelFontSize: 12, titleFontSize: 13, titleFontWeight: 400 };
const lines = { domainColor: "var(--line)", tickColor: "var(--line)", gridColor: "var(--grid)" };
const config = { background: null, font: "system-ui, sans-serif", view: { stroke: null }, axis: { ...text, ...lines } };
const views = {};

async function draw(place) {
  const name = place.dataset.plot;
  const options = { renderer: "svg", actions: false, config, tooltip: { theme: "page" } };
  views[name] = (await vegaEmbed(place, plots[name], options)).view;
  place.dataset.drawn = "";
  if (name === "precision") choose();
}

function choose() {
  const scene = document.querySelector("input[name=case]:checked").value;
  const tools = [...document.querySelectorAll("input[name=tool]:checked")].map((box) => box.value);
  for (const table of document.querySelectorAll("[data-case]")) table.hidden = table.dataset.case !== scene;
  if (views.precision) views.precision.signal("scene", scene).signal("shown", tools).runAsync();
}

// A formula that is wider than the screen can be scrolled, with the keyboard as well.
function reach() {
  for (const formula of document.querySelectorAll(".formula")) {
    if (formula.scrollWidth > formula.clientWidth) formula.tabIndex = 0;
    else formula.removeAttribute("tabindex");
  }
}

const watcher = new IntersectionObserver(
  (entries) => {
    for (const entry of entries.filter((one) => one.isIntersecting)) {
      watcher.unobserve(entry.target);
      draw(entry.target);
    }
  },
  { rootMargin: "600px" },
);
for (const place of document.querySelectorAll(".chart")) watcher.observe(place);
for (const input of document.querySelectorAll(".controls input")) input.addEventListener("change", choose);
addEventListener("resize", reach);
reach();
choose();
