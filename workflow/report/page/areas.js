// areas of rooms, and what openings join, with what was said: at once where that is simple, as when corrections are carried out
const areas = (() => {
  const { plan } = planView;
  const reach = 0.5; // metres by which a line that parts a room is made longer
  const least = 0.2; // square metres of a part: less is a niche
  const thickest = 1.0; // metres between rooms that are one
  const thin = 0.01; // metres that half a wall of no known thickness takes
  const given = [...plan.querySelectorAll(".room")].map((path) => ({ element: path.dataset.element, shape: shapes.read(path.getAttribute("d")) }));
  const joined = [...plan.querySelectorAll('.pick[data-element^="opening "]')].map(({ dataset: { element, rooms } }) => [element, rooms.split(" ").map((n) => (n === "-1" ? null : `room ${n}`))]);
  let rooms = [];
  let neighbours = new Map();

  const lines = new Map(); // along paths a browser measures slowly
  function lineOf(element) {
    if (!lines.has(element)) lines.set(element, edits.lineOf(element));
    return lines.get(element);
  }
  const holds = (room, at) => room.pieces.some((piece) => shapes.has(piece, at));
  const roomAt = (at) => rooms.find((room) => holds(room, at));
  const change = (room, isKnown) => Object.assign(room, { isChanged: true, isKnown });
  const rename = (from, to) => {
    for (const sides of neighbours.values()) sides.forEach((side, i) => { if (side === from) sides[i] = to; });
  };

  // --- walls and openings as they will be ---
  const isGone = (entry) => entry && edits.isNew(entry) && (entry.action === "remove" || entry.kind);
  const sideLines = ([a, b], half) => {
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    const [nx, ny] = [(-(b[1] - a[1]) / length) * half, ((b[0] - a[0]) / length) * half];
    return [[[a[0] + nx, a[1] + ny], [b[0] + nx, b[1] + ny]], [[b[0] - nx, b[1] - ny], [a[0] - nx, a[1] - ny]]];
  };
  function moveWalls() {
    for (const entry of edits.fresh()) {
      const element = edits.elementOf(entry);
      if (entry.element !== "wall" || !element || isGone(entry) || !(entry.line || entry.thickness_m)) continue;
      const part = edits.partOf(element);
      if (part.getAttribute("d").split("L").length > 2) continue; // curved walls stay
      const old = lineOf(element);
      const half = Number(part.dataset.thickness) / 2;
      const isTurned = entry.line && (entry.line[1][0] - entry.line[0][0]) * (old[1][0] - old[0][0]) + (entry.line[1][1] - entry.line[0][1]) * (old[1][1] - old[0][1]) < 0;
      const line = (isTurned ? entry.line.toReversed() : entry.line) ?? old;
      followSides(sideLines(old, half), sideLines(line, half));
      if (entry.thickness_m && half) followSides(sideLines(line, half), sideLines(line, entry.thickness_m / 2));
    }
  }
  function followSides(before, after) {
    before.forEach((side, i) => {
      for (const room of rooms) {
        const moved = shapes.follow(room.pieces[0], side, after[i]);
        if (moved === room.pieces[0]) continue;
        if (!moved) change(room, false);
        if (!moved || Math.abs(shapes.areaOf(moved) - shapes.areaOf(room.pieces[0])) < 1e-4) continue;
        room.pieces = [moved];
        room.isMoved = true;
        change(room, room.isKnown);
      }
    });
  }
  const parts = (kind) => [...plan.querySelectorAll(`.pick[data-element^="${kind} "]`)].map(({ dataset }) => [dataset, edits.entryOf(dataset.element)]).filter(([, entry]) => !isGone(entry));
  const added = (kind) => edits.fresh().filter(({ element, action }) => element === kind && action === "add");
  function listWalls() {
    const half = (thickness) => Math.max((thickness || 0) / 2, thin);
    return [...parts("wall").map(([{ element, thickness }, entry]) => ({ line: entry?.line ?? lineOf(element), half: half(entry?.thickness_m ?? Number(thickness)),
      isCurved: edits.partOf(element).getAttribute("d").split("L").length > 2 })), ...added("wall").map((entry) => ({ line: entry.line, half: half(entry.thickness_m), isCurved: false }))];
  }
  const isOpen = (entry) => !(entry && edits.isNew(entry) && entry.action === "remove");
  const listOpenings = () => [...parts("opening").filter(([, entry]) => isOpen(entry)).map(([{ element }, entry]) => entry?.line ?? lineOf(element)), ...added("opening").map(({ line }) => line)];

  // --- rooms parted and joined ---
  function split(entry, pending) {
    const inside = (room) => (room.pieces.length === 1 ? shapes.lengthIn(room.pieces[0], entry.line) : 0);
    const room = rooms.reduce((best, each) => (inside(each) > inside(best) ? each : best), rooms[0]);
    if (!room || !inside(room)) return roomAt(edits.middle(entry.line)) && change(roomAt(edits.middle(entry.line)), false);
    const others = pending.filter((each) => each.room === room).map(({ line }) => line);
    const found = partBy(room.pieces[0], [entry.line, ...others]);
    if (!found) {
      pending.push({ room, line: entry.line });
      return change(room, false);
    }
    const made = found.slice(1).map((piece) => ({ element: `part ${rooms.length} of ${room.element}`, of: room.element, isMoved: room.isMoved, pieces: [piece], between: 0 }));
    room.pieces = [found[0]];
    for (const each of [room, ...made]) change(each, true);
    rooms.push(...made);
    for (const [opening, sides] of neighbours) {
      if (!sides.includes(room.element)) continue;
      const at = edits.middle(lineAt(opening));
      const nearest = [room, ...made].reduce((best, each) => (shapes.distance(each.pieces[0], at) < shapes.distance(best.pieces[0], at) ? each : best), room);
      sides.forEach((side, i) => { if (side === room.element) sides[i] = nearest.element; });
    }
    pending.splice(0, Infinity, ...pending.filter((each) => each.room !== room));
  }
  function partBy(shape, lines) {
    const pieces = lines.flatMap((line) => {
      const length = Math.hypot(line[1][0] - line[0][0], line[1][1] - line[0][1]);
      return shapes.pieces(shape, line, reach).map((piece) => ({ ...piece, isLoose: piece.from <= -reach || piece.to >= length + reach }));
    });
    if (pieces.some(({ isLoose }) => isLoose)) return null;
    const found = shapes.part(shape, pieces.map(({ ends }) => ends));
    const isSimple = found && found.length >= 2 && found.length <= 1 + lines.length && shapes.areaOf(found.at(-1)) >= least;
    return isSimple ? found : null;
  }
  const lineAt = (opening) => (opening.startsWith("entry") ? edits.entries()[Number(opening.split(" ")[1])].line : edits.entryOf(opening)?.line ?? lineOf(opening));
  function merge(entry) {
    const both = [entry.at, entry.with].map(roomAt);
    if (!both[0] || !both[1] || both[0] === both[1]) return;
    // a part and a room are called as the room is
    const [room, other] = both[0].of && !both[1].of ? both.toReversed() : both;
    const pairs = room.pieces.flatMap((one) => other.pieces.map((two) => [one, two]));
    const [one, two] = pairs.reduce((best, each) => (shapes.gapOf(...each) < shapes.gapOf(...best) ? each : best));
    if (shapes.gapOf(one, two) > thickest) return change(room, false);
    const filled = shapes.between(one, two, listWalls(), listOpenings());
    if (filled === null) return [room, other].forEach((each) => change(each, false));
    const isKnown = room.isKnown && other.isKnown;
    room.pieces.push(...other.pieces);
    room.between += other.between + filled;
    change(room, isKnown);
    rename(other.element, room.element);
    rooms = rooms.filter((each) => each !== other);
    gone.push(other);
  }
  let gone = [];

  function compute() {
    rooms = given.map(({ element, shape }) => ({ element, pieces: [shape], between: 0, isKnown: true, isChanged: false }));
    gone = [];
    neighbours = new Map(joined.filter(([element]) => isOpen(edits.entryOf(element))).map(([element, sides]) => [element, [...sides]]));
    moveWalls();
    edits.entries().forEach((entry, number) => { if (edits.isNew(entry) && entry.element === "opening" && entry.action === "add") neighbours.set(`entry ${number}`, sidesOf(entry.line)); });
    const pending = [];
    for (const entry of edits.fresh()) {
      if (entry.action === "split") split(entry, pending);
      else if (entry.action === "merge") merge(entry);
    }
    for (const entry of edits.fresh()) {
      const element = entry.element === "room" && entry.action === "remove" && edits.elementOf(entry);
      if (!element) continue;
      rename(element, null);
      rooms = rooms.filter((room) => room.element !== element);
    }
    // what was carried out before cannot be taken back without the plan that it was carried out on
    const follows = (entry) => ["split", "merge"].includes(entry.action) || entry.line || entry.thickness_m || (entry.element === "room" && entry.action === "remove");
    for (const entry of edits.gone().filter((each) => follows(each) && !edits.entries().some((other) => edits.isSame(other, each)))) {
      for (const room of rooms) if (room.pieces.some((piece) => shapes.distance(piece, edits.spotOf(entry)) < reach)) change(room, false);
    }
  }
  function sidesOf(line) {
    const [[ax, ay], [bx, by]] = line;
    const length = Math.hypot(bx - ax, by - ay);
    const [x, y] = edits.middle(line);
    return [1, -1].map((side) => roomAt([x - (side * reach * (by - ay)) / length, y + (side * reach * (bx - ax)) / length])?.element ?? null);
  }
  edits.onChange(compute);

  const areaOf = (room) => room.between + room.pieces.reduce((total, piece) => total + shapes.areaOf(piece), 0);
  const nameOf = (element) => {
    if (!element) return "outside";
    const [, of] = / of (room \d+)$/.exec(element) ?? [];
    return of ? `a part of ${choices.roomName(of)}` : choices.roomName(element);
  };
  return {
    list: () => rooms.map((room) => ({ ...room, area_m2: areaOf(room), place: shapes.within(room.pieces[0]) })),
    gone: () => gone.map(({ element }) => element),
    of: (element) => rooms.find((room) => room.element === element),
    // what openings lead from a room to others, or what an opening joins, in words; nothing where that is as it was
    describe(element) {
      const room = rooms.find((each) => each.element === element);
      const lines = [];
      if (room?.isChanged) lines.push(room.isKnown ? `Area with your changes: ${areaOf(room).toFixed(2)} m²` : "Area: to be recomputed");
      const sides = neighbours.get(element);
      const before = joined.find(([each]) => each === element)?.[1];
      if (sides && String(sides) !== String(before)) lines.push(`Joins with your changes: ${sides.map(nameOf).join(" – ")}`);
      if (room?.isChanged) {
        const beside = [...neighbours.values()].filter((each) => each.includes(element)).map(([a, b]) => nameOf(a === element ? b : a));
        lines.push(`Leads to: ${[...new Set(beside)].sort().join(", ") || "nothing"}`);
      }
      return lines;
    },
    neighboursOf: (element) => neighbours.get(element),
  };
})();
