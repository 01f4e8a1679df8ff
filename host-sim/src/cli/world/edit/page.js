"use strict";
// Draws what the server projects, tells it what to hide and show. The server holds the truth: a reload loses nothing.

const get = (id) => document.getElementById(id);
const view = get("view"), plan = get("plan");
const TURN_DEG = 15, FINE_TURN_DEG = 3, WIDTH_DEG = 90, REACH_PX = 8, DRAG_PX = 4;

let world = null;
let seen = { segments: [] };        // the last answer to `view`
let viewpoint = 0, heading = 0;     // place in the list, degrees
let tool = "turn", drag = null, pointed = null;
let isAsking = false, isStale = false;

// Talking to the server

async function ask(path, body) {
  const how = body === undefined ? {} : { method: "POST", body };
  const answer = await fetch(path, how).catch(() => null);
  if (!answer) throw new Error("the editor does not answer: is `edgeloc world edit` still running?");
  if (!answer.ok) throw Object.assign(new Error(await answer.text()), { status: answer.status });
  return answer.json();
}

function hint(text) { get("hint").textContent = text || "\u00a0"; }

/// Asks for the picture anew; while one is under way, once more after it.
async function look() {
  history.replaceState(null, "", `#viewpoint=${viewpoint}&heading=${heading}`);
  isStale = true;
  if (isAsking) return;
  isAsking = true;
  while (isStale) {
    isStale = false;
    try {
      seen = await ask(`view?viewpoint=${viewpoint}&heading=${heading}`);
    } catch (error) { hint(error.message); }
  }
  isAsking = false;
  if (pointed !== null && !drawn().some(([edge]) => edge === pointed)) pointed = null;
  tellState(seen);
  draw();
}

/// Changes something; `words` say what was done.
async function change(path, body = "", words = "") {
  try {
    const state = await ask(path, body);
    if (path === "undo" || path === "redo") viewpoint = state.viewpoint;
    hint(words);
    await look();
  } catch (error) { hint(error.message); }
}

async function save(query = "") {
  try {
    await ask(`save${query}`, "");
    hint("Saved");
    await look();
  } catch (error) {
    if (error.status === 409 && confirm(`${error.message}. Overwrite it?`)) await save("?overwrite=1");
    else hint(error.message);
  }
}

const setVisible = (edges, isVisible, words) =>
  change(`${isVisible ? "show" : "hide"}?viewpoint=${viewpoint}`, JSON.stringify(edges), words);
const undo = () => change("undo", "", "Undone");
const redo = () => change("redo", "", "Done again");

function tellState(state) {
  get("undo").disabled = !state.can_undo;
  get("redo").disabled = !state.can_redo;
  get("save").disabled = state.is_saved;
  get("state").className = state.is_saved ? "" : "unsaved";
  get("state").textContent =
    `${state.visible_count} of ${world.edge_count} edges visible \u00b7 ${state.is_saved ? "saved" : "not saved"}`;
  get("viewpoint").value = viewpoint;
  get("heading").textContent = `${heading}\u00b0`;
}

// Drawing

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name);

/// The context of a canvas, ready to draw in units of which `width` span it.
function begin(canvas, width, height) {
  const pixels = canvas.clientWidth * devicePixelRatio;
  canvas.width = Math.round(pixels);
  canvas.height = Math.round(pixels * height / width);
  const context = canvas.getContext("2d");
  const scale = canvas.width / width;
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.lineCap = "round";
  return context;
}

/// The segments that are drawn: the visible ones, and the hidden ones near enough.
function drawn() {
  const reach = Number(get("reach").value);
  return seen.segments.filter(([, , , , , isVisible, distance]) => isVisible || distance < reach);
}

function stroke(context, segments, style, width) {
  context.beginPath();
  for (const [, x1, y1, x2, y2] of segments) { context.moveTo(x1, y1); context.lineTo(x2, y2); }
  context.strokeStyle = style;
  context.lineWidth = width;
  context.stroke();
}

function draw() {
  if (!world) return;
  const [width, height] = world.size_px;
  const context = begin(view, width, height);
  const unit = width / view.clientWidth;
  const segments = drawn();
  stroke(context, segments.filter((segment) => !segment[5]), colour("--faint"), unit);
  stroke(context, segments.filter((segment) => segment[5]), colour("--ink"), 1.6 * unit);
  stroke(context, segments.filter(([edge]) => edge === pointed), colour("--accent"), 4 * unit);
  if (drag && drag.isArea) {
    context.strokeStyle = colour("--accent");
    context.lineWidth = 1.5 * unit;
    context.setLineDash([6 * unit, 4 * unit]);
    context.strokeRect(drag.from.x, drag.from.y, drag.to.x - drag.from.x, drag.to.y - drag.from.y);
  }
  drawPlan();
}

/// The part of the floor that the plan shows, in metres.
function planBounds() {
  const bounds = { west: Infinity, south: Infinity, east: -Infinity, north: -Infinity };
  const take = (x, y) => {
    bounds.west = Math.min(bounds.west, x - 0.3);
    bounds.south = Math.min(bounds.south, y - 0.3);
    bounds.east = Math.max(bounds.east, x + 0.3);
    bounds.north = Math.max(bounds.north, y + 0.3);
  };
  for (const [x1, y1, x2, y2] of world.plan) { take(x1, y1); take(x2, y2); }
  for (const [, x, y] of world.viewpoints) take(x, y);
  return bounds;
}

const toPlan = (x, y) => ({ x: x - world.bounds.west, y: world.bounds.north - y });

function drawPlan() {
  const { west, south, east, north } = world.bounds, width = east - west, height = north - south;
  const context = begin(plan, width, height);
  const unit = width / plan.clientWidth;
  stroke(context, world.plan.map(([x1, y1, x2, y2]) => {
    const from = toPlan(x1, y1), to = toPlan(x2, y2);
    return [0, from.x, from.y, to.x, to.y];
  }), colour("--plan"), 0.6 * unit);
  world.viewpoints.forEach(([, x, y], index) => {
    const { x: px, y: py } = toPlan(x, y);
    context.beginPath();
    context.arc(px, py, (index === viewpoint ? 5 : 2.5) * unit, 0, 7);
    context.fillStyle = colour(index === viewpoint ? "--accent" : "--ink");
    context.fill();
  });
  const [, x, y] = world.viewpoints[viewpoint], { x: px, y: py } = toPlan(x, y);
  context.beginPath();
  context.moveTo(px, py);
  for (const side of [-0.5, 0.5]) {
    const angle = (heading + side * WIDTH_DEG) * Math.PI / 180;
    context.lineTo(px + 34 * unit * Math.cos(angle), py - 34 * unit * Math.sin(angle));
  }
  context.closePath();
  context.globalAlpha = 0.3;
  context.fillStyle = colour("--accent");
  context.fill();
}

// Pointing

function placeOn(canvas, event, width) {
  const box = canvas.getBoundingClientRect();
  const scale = width / canvas.clientWidth;
  return { x: (event.clientX - box.left - canvas.clientLeft) * scale,
           y: (event.clientY - box.top - canvas.clientTop) * scale };
}

function distance({ x, y }, [, x1, y1, x2, y2]) {
  const dx = x2 - x1, dy = y2 - y1;
  const along = Math.max(0, Math.min(1, ((x - x1) * dx + (y - y1) * dy) / (dx * dx + dy * dy || 1)));
  return Math.hypot(x - x1 - along * dx, y - y1 - along * dy);
}

/// The drawn segment at a place, a visible one before a hidden one.
function segmentAt(place) {
  const unit = world.size_px[0] / view.clientWidth;
  let best = null, least = REACH_PX * unit;
  for (const segment of drawn()) {
    const apart = distance(place, segment) + (segment[5] ? 0 : 3 * unit);
    if (apart < least) [best, least] = [segment, apart];
  }
  return best;
}

function turnTo(degrees) {
  heading = Math.round(((degrees % 360) + 360) % 360 * 10) / 10;
  look();
}

function goTo(index) {
  const count = world.viewpoints.length;
  viewpoint = ((index % count) + count) % count;
  pointed = null;
  look();
}

view.addEventListener("pointerdown", (event) => {
  if (!world || event.button !== 0) return;
  const place = placeOn(view, event, world.size_px[0]);
  drag = { from: place, to: place, heading, isArea: tool !== "turn", isMoved: false };
  view.setPointerCapture(event.pointerId);
});

view.addEventListener("pointermove", (event) => {
  if (!world) return;
  const place = placeOn(view, event, world.size_px[0]);
  if (!drag) {
    const segment = tool === "turn" ? segmentAt(place) : null;
    if ((segment ? segment[0] : null) !== pointed) { pointed = segment ? segment[0] : null; draw(); }
    return;
  }
  drag.to = place;
  const unit = world.size_px[0] / view.clientWidth;
  drag.isMoved ||= Math.hypot(place.x - drag.from.x, place.y - drag.from.y) > DRAG_PX * unit;
  if (!drag.isMoved) return;
  if (drag.isArea) draw();
  else {
    view.classList.add("turning");
    turnTo(drag.heading + (place.x - drag.from.x) / world.size_px[0] * WIDTH_DEG);
  }
});

view.addEventListener("pointerup", () => {
  const ended = drag;
  drag = null;
  view.classList.remove("turning");
  if (!ended) return;
  if (!ended.isMoved) {
    const segment = segmentAt(ended.to);
    if (segment) setVisible([segment[0]], !segment[5]);
    else draw();
  } else if (ended.isArea) {
    const [left, right] = [ended.from.x, ended.to.x].sort((a, b) => a - b);
    const [top, bottom] = [ended.from.y, ended.to.y].sort((a, b) => a - b);
    const isIn = (x, y) => x >= left && x <= right && y >= top && y <= bottom;
    const isShown = tool === "show";
    const inside = drawn().filter(([, x1, y1, x2, y2, isVisible]) =>
      isIn(x1, y1) && isIn(x2, y2) && Boolean(isVisible) !== isShown);
    const words = `${inside.length} ${inside.length === 1 ? "edge" : "edges"} ${isShown ? "shown" : "hidden"}`;
    if (inside.length) setVisible(inside.map(([edge]) => edge), isShown, words);
    else { hint(words); draw(); }
  }
});

view.addEventListener("pointercancel", () => { drag = null; draw(); });

plan.addEventListener("click", (event) => {
  if (!world) return;
  const place = placeOn(plan, event, world.bounds.east - world.bounds.west);
  let best = 0, least = Infinity;
  world.viewpoints.forEach(([, x, y], index) => {
    const at = toPlan(x, y), apart = Math.hypot(at.x - place.x, at.y - place.y);
    if (apart < least) [best, least] = [index, apart];
  });
  goTo(best);
});

// Buttons and keys

function take(name) {
  tool = name;
  for (const button of document.querySelectorAll("[data-tool]")) {
    button.setAttribute("aria-pressed", String(button.dataset.tool === name));
  }
  view.classList.toggle("area", name !== "turn");
  pointed = null;
  draw();
}

/// Points at the next drawn segment, counted from left to right.
function pointAtNext(step) {
  const middle = ([, x1, , x2]) => x1 + x2;
  const inOrder = drawn().sort((a, b) => middle(a) - middle(b));
  if (!inOrder.length) return;
  const at = inOrder.findIndex(([edge]) => edge === pointed);
  const next = at < 0 ? (step > 0 ? 0 : inOrder.length - 1) : (at + step + inOrder.length) % inOrder.length;
  pointed = inOrder[next][0];
  hint(`Edge ${pointed}, ${inOrder[next][5] ? "visible" : "hidden"}`);
  draw();
}

function togglePointed() {
  const segment = drawn().find(([edge]) => edge === pointed);
  if (segment) setVisible([pointed], !segment[5]);
}

document.addEventListener("keydown", (event) => {
  if (!world || get("keys").open || event.altKey) return;
  const key = event.key.toLowerCase();
  const act = (action) => { event.preventDefault(); action(); };
  if (event.ctrlKey || event.metaKey) {
    if (key === "s") act(() => save());
    else if (key === "y" || (key === "z" && event.shiftKey)) act(redo);
    else if (key === "z") act(undo);
    return;
  }
  const isElsewhere = event.target.matches("select, button");
  const turn = event.shiftKey ? FINE_TURN_DEG : TURN_DEG;
  if (key === "arrowleft" && !isElsewhere) act(() => turnTo(heading + turn));
  else if (key === "arrowright" && !isElsewhere) act(() => turnTo(heading - turn));
  else if (key === " " && !isElsewhere) act(togglePointed);
  else if (key === "pageup") act(() => goTo(viewpoint - 1));
  else if (key === "pagedown") act(() => goTo(viewpoint + 1));
  else if (key === ",") act(() => pointAtNext(-1));
  else if (key === ".") act(() => pointAtNext(1));
  else if (key === "t") take("turn");
  else if (key === "h") take("hide");
  else if (key === "s") take("show");
  else if (key === "?") act(() => get("keys").showModal());
  else if (key === "escape") { drag = null; draw(); }
});

for (const button of document.querySelectorAll("[data-tool]")) {
  button.addEventListener("click", () => take(button.dataset.tool));
}
get("undo").addEventListener("click", undo);
get("redo").addEventListener("click", redo);
get("save").addEventListener("click", () => save());
get("help").addEventListener("click", () => get("keys").showModal());
get("viewpoint").addEventListener("change", (event) => goTo(Number(event.target.value)));
get("reach").addEventListener("change", draw);
addEventListener("resize", draw);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
addEventListener("beforeunload", (event) => { if (seen.is_saved === false) event.preventDefault(); });

async function start() {
  world = await ask("world");
  world.bounds = planBounds();
  document.title = `${world.name}: what is visible`;
  get("name").textContent = world.name;
  get("name").title = world.file;
  world.viewpoints.forEach(([id, x, y], index) => {
    get("viewpoint").append(new Option(`${id} at ${x.toFixed(2)}, ${y.toFixed(2)} m`, index));
  });
  get("reach").value = "4";
  const asked = new URLSearchParams(location.hash.slice(1));
  const isThere = Number(asked.get("viewpoint")) < world.viewpoints.length;
  viewpoint = isThere ? Math.max(0, Math.floor(Number(asked.get("viewpoint")))) : 0;
  heading = Number(asked.get("heading")) || 0;
  await look();
  view.focus();
}

start().catch((error) => { get("state").textContent = error.message; });
