// what a person has said of the plan: kept in this browser, undone and redone, as entries of corrections.yaml
const edits = (() => {
  const { data, plan } = planView;
  const key = `scanplan ${data.survey}`;
  const reach = 0.5; // metres from a place to its element, as when corrections are carried out
  let given = data.corrections;
  let steps = [];
  let done = 0;
  let by = "";
  let seen; // which file of corrections this page knows
  const listeners = [];

  // entries never change: what was worked out of one holds
  function remember(work) {
    const known = new WeakMap();
    return (entry) => {
      if (!known.has(entry)) known.set(entry, work(entry));
      return known.get(entry);
    };
  }
  // who said it, and when, makes no other entry of it
  const said = remember((entry) => JSON.stringify(Object.entries(entry).filter(([name]) => name !== "when" && name !== "by").sort()));
  const has = (list, entry) => list.some((other) => said(other) === said(entry));
  const isOutline = (entry) => ["split", "merge", "settle"].includes(entry.action);
  // two of the same place are refused when they are saved, whichever way a line was drawn
  const identify = (entry) => JSON.stringify([entry.element, isOutline(entry) && entry.action, entry.at ?? (entry.line ? middle(entry.line) : entry.outline), entry.with]);

  function replace(list, { before, after }) {
    const at = before ? list.findIndex((entry) => said(entry) === said(before)) : -1;
    if (at < 0) return after && !has(list, after) ? [...list, after] : list;
    return list.toSpliced(at, 1, ...(after ? [after] : []));
  }
  let current = given;
  let entryAt = new Map();
  function changed() {
    current = steps.slice(0, done).reduce(replace, given);
    entryAt = new Map(current.map((entry) => [elementOf(entry), entry]).reverse());
    for (const listener of listeners) listener();
  }

  function store() {
    try {
      localStorage.setItem(key, JSON.stringify({ given, steps, done, by, seen }));
      return true;
    } catch {
      return false; // a browser may keep nothing for files, or be full
    }
  }

  // what was just said, more exactly: of the same step, unless it was taken back since
  function refine(entry, more) {
    const last = steps.at(-1);
    if (done < steps.length || !last?.after || said(last.after) !== said(entry)) return false;
    steps = [...steps.slice(0, -1), { ...last, after: { ...last.after, ...more } }];
    store();
    changed();
    return true;
  }

  // what was changed from one list to another, as steps on a third: nothing is lost where both changed
  function rebase(before, after, onto) {
    const more = [];
    for (const entry of before) if (!has(after, entry) && has(onto, entry)) more.push({ before: entry, after: null });
    for (const entry of after) {
      if (has(before, entry) || has(onto, entry)) continue;
      const other = onto.find((old) => identify(old) === identify(entry));
      more.push({ before: other ?? null, after: entry });
    }
    return more.filter(({ before: old, after: entry }) => entry || !more.some((step) => step.after && step.before === old));
  }

  // the page may have been made anew since, or another window may have gone on
  function load() {
    let stored = null;
    try {
      stored = JSON.parse(localStorage.getItem(key));
    } catch {
      return "";
    }
    if (!stored || !Array.isArray(stored.given) || !Array.isArray(stored.steps)) return "";
    by = String(stored.by ?? "");
    seen = stored.seen;
    if (stored.given.length === given.length && stored.given.every((entry) => has(given, entry))) {
      ({ steps, done } = stored);
      return "";
    }
    const mine = stored.steps.slice(0, stored.done).reduce(replace, stored.given);
    steps = rebase(stored.given, mine, given);
    done = steps.length;
    return done ? `The plan was made anew since; ${count(done, "change")} of yours not in it ${done > 1 ? "are" : "is"} kept.` : "";
  }
  const count = (n, noun) => `${n} ${noun}${n === 1 ? "" : "s"}`;

  function step(before, after, stamp = { when: new Date().toISOString().replace(/\.\d+/, ""), ...(by ? { by } : {}) }) {
    steps = [...steps.slice(0, done), { before: before ?? null, after: after && { ...after, ...stamp } }];
    done = steps.length;
    store();
    changed();
  }

  // --- elements and entries: by place, as when corrections are carried out ---
  const parts = (kind) => [...plan.querySelectorAll(kind === "room" ? ".room" : `.pick[data-element^="${kind} "]`)];
  const partOf = (element) => plan.querySelector(`.pick[data-element="${element}"], .room[data-element="${element}"]`);
  const place = ({ x, y }) => [Number(x.toFixed(3)), Number((-y).toFixed(3))];
  const middle = ([a, b]) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
  const spotOf = ({ at, line, outline }) => (line ? middle(line) : outline ? middle([outline[0], outline[2]]) : at);
  function lineOf(element) {
    const path = partOf(element);
    return [place(path.getPointAtLength(0)), place(path.getPointAtLength(path.getTotalLength()))];
  }
  function placeOf(element) {
    const part = partOf(element);
    if (part.dataset.x !== undefined) return [Number(part.dataset.x), -Number(part.dataset.y)];
    return place(part.getPointAtLength(part.getTotalLength() / 2));
  }
  function distance([x, y], [[ax, ay], [bx, by_]]) {
    const [dx, dy] = [bx - ax, by_ - ay];
    const t = Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
    return Math.hypot(x - ax - t * dx, y - ay - t * dy);
  }
  const lines = new Map();
  function nearest(kind, at, within = reach) {
    if (kind === "room") return parts(kind).find((part) => part.isPointInFill(new DOMPoint(at[0], -at[1])))?.dataset.element;
    if (!lines.has(kind)) lines.set(kind, parts(kind).map(({ dataset }) => [dataset.element, lineOf(dataset.element)]));
    let found;
    for (const [element, line] of lines.get(kind)) {
      const far = distance(at, line);
      if (far <= within) [within, found] = [far, element];
    }
    return found;
  }
  // what of this page an entry is of: nothing where it is added anew, or gone already
  const elementOf = remember((entry) => {
    const isIn = has(given, entry);
    const isGone = entry.action === "remove" || (entry.element === "wall" && entry.kind);
    if (isOutline(entry) || (isIn ? isGone : entry.action === "add")) return undefined;
    if (!["wall", "face", "opening", "room"].includes(entry.element)) return undefined;
    return nearest(entry.element, isIn && entry.line ? middle(entry.line) : entry.at);
  });
  const entryOf = (element) => entryAt.get(element);

  // what is said of an element joins what was said of it before
  function change(element, more) {
    const old = entryOf(element);
    const [kind] = element.split(" ");
    const { action } = more;
    if (action === "keep" && old && old.action !== "remove") return;
    if (old?.action === "add" && (action === "remove" || (kind === "wall" && more.kind))) return step(old, null);
    if (old?.action === "add" && more.width_m) return step(old, { ...old, line: widen(old.line, more.width_m) });
    if (old?.action === "add") return step(old, { ...old, ...more });
    const { action: _, when, by: __, ...known } = old ?? {};
    const base = { element: kind, at: old?.at ?? placeOf(element) };
    step(old, action ? { ...base, action } : { ...base, ...known, ...more });
  }
  function widen(line, width) {
    const [x, y] = middle(line);
    const length = Math.hypot(line[1][0] - line[0][0], line[1][1] - line[0][1]);
    const [dx, dy] = [0, 1].map((i) => ((line[1][i] - line[0][i]) / length) * (width / 2));
    return [[x - dx, y - dy], [x + dx, y + dy]].map((end) => end.map((m) => Number(m.toFixed(3))));
  }

  // what others have saved since; of an element that both spoke of, what was said here stays
  function adopt(saved, revision) {
    if (revision === seen) return; // what was taken back since is not to come again
    know(revision);
    for (const entry of saved) {
      const other = current.find((old) => identify(old) === identify(entry));
      if (!has(current, entry) && !has(given, entry) && !(other && !has(given, other))) step(other, entry, {});
    }
    for (const entry of given) if (!has(saved, entry) && has(current, entry)) step(entry, null);
  }

  function know(revision) {
    seen = revision;
    store();
  }

  const news = load();
  addEventListener("storage", (event) => {
    if (event.key !== key || !event.newValue) return;
    ({ given, steps, done, by, seen } = JSON.parse(event.newValue));
    changed();
    planView.say("Changed in another window", 3);
  });
  return {
    news, count, place, middle, spotOf, lineOf, placeOf, partOf, nearest, distance, elementOf, entryOf, widen, change,
    entries: () => current,
    isNew: (entry) => !has(given, entry),
    fresh: () => current.filter((entry) => !has(given, entry)),
    gone: () => given.filter((entry) => !has(current, entry)),
    add: (entry) => step(current.find((old) => identify(old) === identify(entry)), entry),
    refine,
    takeBack: (entry) => step(entry, null),
    bring: (entry) => step(current.find((old) => identify(old) === identify(entry)), entry),
    adopt, know, tell: said,
    has: (entry) => has(current, entry),
    isSame: (one, other) => identify(one) === identify(other),
    undo: () => { done = Math.max(0, done - 1); store(); changed(); },
    redo: () => { done = Math.min(steps.length, done + 1); store(); changed(); },
    canUndo: () => done > 0,
    canRedo: () => done < steps.length,
    name: (text) => { by = text.trim(); store(); },
    who: () => by,
    keeps: store,
    onChange: (listener) => listeners.push(listener),
    begin: changed,
  };
})();
