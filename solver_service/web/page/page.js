// The operator's page. It shows what /v1/events says and asks for actions by REST.
// Texts of others (labels, names, sentences) only ever become text nodes, never markup.
"use strict";

const KEY = "fev-token";
const SECTIONS = ["service", "runs", "devices", "gpus", "workers", "connections", "uploads", "events"];
const STALE_MS = 25000;
let known = empty();
let token = sessionStorage.getItem(KEY) || "";
let heard = 0;
let reading = null;
let attempt = 0;

function empty() {
  return Object.fromEntries(SECTIONS.map((name) => [name, new Map()]));
}

const byId = (id) => document.getElementById(id);

function node(tag, className, ...inner) {
  const made = document.createElement(tag);
  if (className) made.className = className;
  for (const part of inner) {
    if (part !== null && part !== undefined && part !== "") made.append(part);
  }
  return made;
}

// --- numbers for people ---------------------------------------------------------------------------

function bytes(count) {
  if (count === null || count === undefined) return "";
  const units = ["B", "kB", "MB", "GB", "TB"];
  let step = 0;
  while (count >= 999.5 && step < units.length - 1) { count /= 1000; step += 1; }
  return `${step && count < 99.5 ? count.toPrecision(2).replace(/e.*/, "") : Math.round(count)}\u00a0${units[step]}`;
}

function lasting(seconds) {
  if (seconds === null || seconds === undefined) return "";
  if (seconds < 60) return `${Math.round(seconds)}\u00a0s`;
  if (seconds < 3600) return `${Math.floor(seconds / 60)}\u00a0min`;
  if (seconds < 86400) return `${Math.floor(seconds / 3600)}\u00a0h ${Math.floor((seconds % 3600) / 60)}\u00a0min`;
  return `${Math.floor(seconds / 86400)}\u00a0d ${Math.floor((seconds % 86400) / 3600)}\u00a0h`;
}

function simulated(seconds) {
  const whole = Math.round(seconds);
  const two = (part) => String(part).padStart(2, "0");
  return `${Math.floor(whole / 3600)}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
}

function counted(count) {
  if (count >= 1e6) return `${(count / 1e6).toPrecision(3)}\u00a0M`;
  return count.toLocaleString("en").replaceAll(",", "\u202f");
}

const age = (since) => lasting(Math.max(0, Date.now() / 1000 - since));

// --- tables ---------------------------------------------------------------------------------------

// Rows are made again only when what they show has changed, so that the focus stays where it is.
function fill(id, rows, cells, nothing) {
  const body = byId(id).tBodies[0];
  const labels = [...byId(id).tHead.rows[0].cells].map((cell) => cell.textContent);
  const old = new Map([...body.rows].map((row) => [row.dataset.id, row]));
  const wanted = rows.map(([name, facts]) => {
    const shown = JSON.stringify(facts);
    const before = old.get(name);
    if (before && before.dataset.shown === shown) return before;
    const row = node("tr");
    row.dataset.id = name;
    row.dataset.shown = shown;
    cells(facts).forEach((cell, place) => {
      if (cell.tagName !== "TH") cell.dataset.label = labels[place] || "";
      row.append(cell);
    });
    const focus = before && before.contains(document.activeElement) ? document.activeElement.dataset.action : null;
    if (focus) requestAnimationFrame(() => row.querySelector(`[data-action="${focus}"]`)?.focus());
    return row;
  });
  if (!wanted.length) {
    const row = node("tr", "", node("td", "none", nothing));
    row.cells[0].colSpan = labels.length;
    wanted.push(row);
  }
  if (wanted.length !== body.rows.length || wanted.some((row, place) => body.rows[place] !== row)) {
    body.replaceChildren(...wanted);
  }
}

function bar(share, label) {
  const made = node("progress");
  made.max = 1;
  if (share !== null) made.value = Math.min(1, Math.max(0, share));
  made.setAttribute("aria-label", label);
  return made;
}

function button(text, action, label, does, className = "") {
  const made = node("button", className, text);
  made.type = "button";
  made.dataset.action = action;
  made.setAttribute("aria-label", label);
  made.addEventListener("click", does);
  return made;
}

// Runs as a tree: children below their parent, the newest tree first.
function ordered(runs) {
  const children = new Map();
  for (const run of runs.values()) {
    const parent = runs.has(run.parent) ? run.parent : "";
    children.set(parent, [...(children.get(parent) || []), run]);
  }
  const found = [];
  const walk = (run, depth) => {
    found.push([run.run, { ...run, depth: Math.min(depth, 4) }]);
    for (const child of children.get(run.run) || []) walk(child, depth + 1);
  };
  for (const run of (children.get("") || []).reverse()) walk(run, 0);
  return found;
}

function runCells(run) {
  const name = node("th", `depth-${run.depth}`, node("span", "name", run.label || run.title || run.case));
  name.scope = "row";
  name.append(node("span", "small", `${run.case} \u00b7 ${counted(run.cells)} cells \u00b7 ${run.device}`));
  name.append(node("span", "id", run.run), run.pinned ? node("span", "small", "pinned") : "");
  const status = node("td", "", node("span", `badge ${run.status}`, run.status), node("span", "small", run.reason));
  const share = run.duration > 0 ? run.time / run.duration : 0;
  const progress = node("td", "", bar(share, `progress of run ${run.run}`));
  progress.append(node("span", "small", `${simulated(run.time)} of ${simulated(run.duration)}, ${run.frames} frames`));
  const speed = run.speed === null || run.speed === undefined ? "" : `${counted(Math.round(run.speed))} x`;
  const error = run.volume_error === undefined ? "" : run.volume_error.toExponential(1);
  const controller = node("td", "", run.controller ? run.controller_client || "a viewer" : "");
  if (run.controller) controller.append(node("span", "id", run.controller));
  if (run.viewers) controller.append(node("span", "small", `${run.viewers} watching`));
  return [
    name, status, progress, node("td", "number", speed), node("td", "number", lasting(run.eta_s)),
    node("td", "number", error), node("td", "number", bytes(run.size)), controller,
    node("td", "", runActions(run)),
  ];
}

function runActions(run) {
  const words = `run ${run.label || run.run}`;
  const path = `/v1/runs/${encodeURIComponent(run.run)}`;
  const act = (action, question) => () => ask(question, "POST", `${path}/${action}`, `${words}: ${action}`);
  const made = node("div", "actions");
  if (run.status === "running" || run.status === "starting") {
    made.append(button("Pause", "pause", `pause ${words}`, act("pause", `Pause ${words}? Whoever watches it waits.`)));
  }
  if (run.status === "paused" || run.status === "failed") {
    made.append(button("Resume", "resume", `resume ${words}`, act("resume", "")));
  }
  if (["running", "starting", "paused", "failed"].includes(run.status)) {
    made.append(button("Stop", "stop", `stop ${words}`, act("stop", `Stop ${words} for good? Its frames stay.`)));
  }
  const pin = run.pinned ? "unpin" : "pin";
  made.append(button(run.pinned ? "Unpin" : "Pin", "pin", `${pin} ${words}`, act(pin, "")));
  if (!["running", "starting"].includes(run.status)) {
    const question = `Delete ${words} and its ${bytes(run.size)} on disk? This cannot be undone.`;
    const does = () => ask(question, "DELETE", path, `${words}: delete`);
    const last = button("Delete", "delete", `delete ${words}`, does, "danger");
    last.disabled = run.pinned;
    if (run.pinned) last.title = "pinned runs cannot be deleted";
    made.append(last);
  }
  return made;
}

function connectionCells(one) {
  const who = node("th", "", node("span", "name", one.token || "not signed in"), node("span", "small", one.client));
  who.scope = "row";
  who.append(node("span", "id", one.session));
  const path = `/v1/connections/${encodeURIComponent(one.session)}`;
  const words = `the connection of ${one.token || one.address}`;
  const end = button("End", "end", `end ${words}`, () => ask(`End ${words}?`, "DELETE", path, `${words}: end`), "danger");
  const open = node("td", "number", age(one.since));
  open.dataset.since = one.since;
  return [
    who, node("td", "", one.scope || ""), node("td", "", one.address), node("td", "", node("span", "id", one.run || "")),
    node("td", "number", one.run ? `${bytes(one.bytes_per_s)}/s` : ""), node("td", "number", one.run ? String(one.credit) : ""),
    open, node("td", "", end),
  ];
}

function uploadCells(one) {
  const from = node("th", "", node("span", "name", one.case || one.label), node("span", "small", one.case ? one.label : ""));
  from.scope = "row";
  const status = node("td", "", node("span", `badge ${one.status}`, one.status), node("span", "small", one.message));
  for (const warning of one.warnings.slice(0, 3)) status.append(node("span", "small", warning));
  const coming = one.status === "receiving";
  let share = 1;
  if (coming) share = one.bytes_sent ? one.bytes_received / one.bytes_sent : null;
  else if (!one.ended) share = one.stage === "unpacking" ? one.done / 2 : one.stage === "reading" ? 0.5 : one.stage ? 0.75 : 0;
  const told = coming || one.ended || !one.stage ? bytes(one.bytes_received) : one.stage;
  const progress = node("td", "", one.status === "refused" ? "" : bar(share, `progress of upload ${one.upload}`));
  progress.append(node("span", "small", told));
  return [from, status, progress];
}

function tile(title, value, more, share) {
  const made = node("div", "", node("dt", "", title), node("dd", "", value, more ? node("div", "more", more) : ""));
  if (share !== undefined) made.lastChild.append(bar(share, title));
  return made;
}

function glance() {
  const facts = known.service.get("service");
  if (!facts) return;
  const used = facts.disk_bytes - facts.disk_free_bytes;
  const taken = facts.machine_memory_bytes - facts.machine_memory_free_bytes;
  const kept = facts.stored_bytes + facts.uploaded_bytes;
  const ours = facts.memory_bytes + facts.worker_memory_bytes;
  byId("glance").replaceChildren(
    tile("Computing", String(facts.computing), `of ${facts.runs} runs`),
    tile("Connections", String(facts.connections), `longest wait to publish ${(facts.longest_publish_wait_s * 1000).toFixed(1)} ms`),
    tile("Memory", bytes(ours), `machine: ${bytes(taken)} of ${bytes(facts.machine_memory_bytes)} used`, taken / facts.machine_memory_bytes),
    tile("Store", bytes(kept), facts.store_bytes ? `budget ${bytes(facts.store_bytes)}` : "no budget", facts.store_bytes ? facts.stored_bytes / facts.store_bytes : undefined),
    tile("Disk", `${bytes(facts.disk_free_bytes)} free`, `of ${bytes(facts.disk_bytes)}`, used / facts.disk_bytes),
    ...[...known.gpus.values()].map((gpu) => tile(
      `GPU ${gpu.index}`, bytes(gpu.used_bytes), `of ${bytes(gpu.total_bytes)}, ${gpu.name}`, gpu.used_bytes / gpu.total_bytes,
    )),
    tile("Up for", age(facts.since), `version ${facts.version}, process ${facts.pid}`),
  );
}

function events() {
  const list = byId("events");
  const rows = [...known.events.values()].sort((one, other) => other.number - one.number);
  const newest = list.firstElementChild ? Number(list.firstElementChild.dataset.number || 0) : 0;
  if (!rows.length) { list.replaceChildren(node("li", "none", "nothing has happened yet")); return; }
  if (!newest) list.replaceChildren();
  for (const one of rows.filter((row) => row.number > newest).reverse()) {
    const moment = node("time", "", new Date(one.moment * 1000).toLocaleTimeString([], { hour12: false }));
    const text = node("span", "", one.text, one.run ? node("span", "id", ` ${one.run}`) : "");
    const item = node("li", "", moment, node("span", one.level, one.level), text);
    item.dataset.number = one.number;
    list.prepend(item);
  }
  while (list.children.length > rows.length) list.lastElementChild.remove();
}

function show() {
  glance();
  fill("runs", ordered(known.runs), runCells, "no runs");
  fill("devices", [...known.devices], (one) => [
    node("td", "name", one.device), node("td", "number", `${one.runs} ${one.runs === 1 ? "run" : "runs"}`),
    node("td", "number", counted(one.cells)), node("td", "number", String(one.workers)),
  ], "no devices");
  fill("workers", [...known.workers], (one) => [
    node("td", "", `process ${one.pid ?? "?"}`),
    node("td", "", one.run ? node("span", "id", one.run) : one.ready ? "nothing, stands by" : "starting"),
    node("td", "", one.device || ""), node("td", "number", bytes(one.memory_bytes)),
  ], "no workers");
  fill("connections", [...known.connections], connectionCells, "nobody is connected");
  fill("uploads", [...known.uploads].sort((one, other) => other[1].since - one[1].since).slice(0, 10), uploadCells, "no uploads");
  events();
}

// --- actions --------------------------------------------------------------------------------------

const headers = () => ({ Authorization: `Bearer ${token}` });

function confirmed(question) {
  if (!question) return Promise.resolve(true);
  const dialog = byId("confirm");
  byId("confirm-text").textContent = question;
  return new Promise((resolve) => {
    const end = (yes) => () => { dialog.close(); resolve(yes); };
    byId("confirm-yes").onclick = end(true);
    byId("confirm-no").onclick = end(false);
    dialog.oncancel = () => resolve(false);
    dialog.showModal();
    byId("confirm-no").focus();
  });
}

async function ask(question, method, path, words) {
  if (!await confirmed(question)) return;
  try {
    const reply = await fetch(path, { method, headers: headers() });
    if (reply.ok) { say(`${words}: done`); return; }
    const detail = await reply.json().then((body) => body.detail, () => `HTTP status ${reply.status}`);
    say(`${words}: ${typeof detail === "string" ? detail : "not allowed"}`, true);
  } catch (error) {
    say(`${words}: the service cannot be reached`, true);
  }
}

function say(text, isError = false) {
  byId("answer").textContent = text;
  byId("answer").classList.toggle("error", isError);
}

// --- the stream of events ---------------------------------------------------------------------------

function state(text, kind) {
  byId("link").textContent = text;
  byId("link").className = `link ${kind}`;
  byId("board").classList.toggle("stale", kind === "lost");
}

function take(name, data) {
  if (name === "end") throw new Error(JSON.parse(data));
  if (name !== "overview") return;
  const news = JSON.parse(data);
  for (const section of SECTIONS) {
    for (const id of news.gone[section] || []) known[section].delete(id);
    for (const [id, row] of Object.entries(news.set[section] || {})) known[section].set(id, row);
  }
  show();
}

async function listen() {
  reading = new AbortController();
  const reply = await fetch("/v1/events", { headers: headers(), signal: reading.signal, cache: "no-store" });
  if (reply.status === 401 || reply.status === 403) {
    const body = await reply.json();
    throw Object.assign(new Error(body.detail), { refused: true });
  }
  if (!reply.ok) throw new Error(`HTTP status ${reply.status}`);
  known = empty();
  sessionStorage.setItem(KEY, token);
  byId("sign-in").hidden = true;
  byId("board").hidden = false;
  byId("sign-out").hidden = false;
  const reader = reply.body.pipeThrough(new TextDecoderStream()).getReader();
  let rest = "";
  for (;;) {
    const { value, done } = await reader.read();
    if (done) throw new Error("the service has ended the connection");
    heard = Date.now();
    attempt = 0;
    state("live", "live");
    rest += value;
    let at;
    while ((at = rest.indexOf("\n\n")) >= 0) {
      const lines = rest.slice(0, at).split("\n");
      rest = rest.slice(at + 2);
      const field = (key) => lines.filter((line) => line.startsWith(`${key}: `)).map((line) => line.slice(key.length + 2)).join("\n");
      if (field("event")) take(field("event"), field("data"));
    }
  }
}

async function keepListening() {
  while (token) {
    try {
      await listen();
    } catch (error) {
      if (!token) return;
      if (error.refused) { signOut(error.message); return; }
      attempt += 1;
      const wait = Math.min(30, 2 ** Math.min(attempt, 5) / 2);
      const seen = heard ? `, last heard ${age(heard / 1000)} ago` : "";
      state(`connection lost${seen}; trying again in ${wait} s (attempt ${attempt})`, "lost");
      await new Promise((resolve) => setTimeout(resolve, wait * 1000));
    }
  }
}

function signOut(why = "") {
  token = "";
  sessionStorage.removeItem(KEY);
  if (reading) reading.abort();
  known = empty();
  byId("sign-in").hidden = false;
  byId("board").hidden = true;
  byId("sign-out").hidden = true;
  byId("token-error").textContent = why;
  byId("token").value = "";
  byId("token").focus();
  state("not signed in", "");
}

byId("token-form").addEventListener("submit", (event) => {
  event.preventDefault();
  token = byId("token").value.trim();
  byId("token").value = "";
  byId("token-error").textContent = "";
  keepListening();
});
byId("sign-out").addEventListener("click", () => signOut());
setInterval(() => {
  for (const cell of document.querySelectorAll("[data-since]")) cell.textContent = age(Number(cell.dataset.since));
  if (heard && token && Date.now() - heard > STALE_MS && reading) reading.abort();
}, 5000);
if (token) keepListening(); else signOut();
