// the list of changes; corrections.yaml out and in; with `scanplan open` saved and carried out at once
(() => {
  const { data } = planView;
  const { make, button } = choices;
  const byId = (id) => document.getElementById(id);
  const told = byId("told");
  const tell = (text, isWrong = false) => {
    told.textContent = text;
    told.classList.toggle("flag", isWrong);
  };

  const server = {
    async ask(what, body) {
      const answer = await fetch(`api/${what}`, body && { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
      return { status: answer.status, ...(await answer.json()) };
    },
    revision: "",
    isBroken: false, // what is saved was not carried out
    watch: undefined, // who follows a run: what was asked for an earlier one is of before
  };

  function list() {
    const fresh = edits.fresh();
    const gone = edits.gone();
    const item = (words, act, name) => {
      const made = make("li");
      made.append(make("span", words), button("×", act, { "aria-label": `${name}: ${words}` }));
      return made;
    };
    // what cannot be carried out says why, and where it is
    const said = (entry) => {
      const words = choices.describe(entry);
      const made = item(words, () => edits.takeBack(entry), "take back");
      if (!faults.of(entry)) return made;
      made.className = "fault";
      made.firstChild.append(make("span", `Cannot be carried out: ${faults.of(entry)}`, { class: "flag" }));
      made.firstChild.after(button("Show", () => faults.show(entry), { "aria-label": `show: ${words}` }));
      return made;
    };
    byId("fresh").replaceChildren(
      ...fresh.map(said),
      ...gone.map((entry) => item(`Taken back: ${choices.describe(entry)}`, () => edits.bring(entry), "keep after all")),
    );
    const known = edits.entries().filter((entry) => !edits.isNew(entry));
    byId("known").replaceChildren(...known.map(said));
    byId("n-known").textContent = known.length;
    byId("in-plan").hidden = known.length === 0;
    if (known.some(faults.of)) byId("in-plan").open = true;
    const n = fresh.length + gone.length;
    byId("n-fresh").textContent = n ? edits.count(n, "change") : "No changes yet";
    byId("undo").disabled = !edits.canUndo();
    byId("redo").disabled = !edits.canRedo();
    byId("download").disabled = edits.entries().length === 0;
    byId("save").disabled = n === 0 && !server.isBroken;
  }
  edits.onChange(list);
  byId("undo").addEventListener("click", edits.undo);
  byId("redo").addEventListener("click", edits.redo);
  byId("by").value = edits.who();
  byId("by").addEventListener("change", () => edits.name(byId("by").value));
  addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.target.closest?.("input, textarea")) return;
    const act = { z: event.shiftKey ? edits.redo : edits.undo, Z: edits.redo, y: edits.redo }[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });

  // --- the file ---
  const write = () => {
    const lines = edits.entries().map((entry) => `- ${JSON.stringify(entry)}\n`);
    return `${data.survey ? `survey: ${JSON.stringify(data.survey)}\n` : ""}corrections:\n${lines.join("")}`;
  };
  byId("download").addEventListener("click", () => {
    const file = new Blob([write()], { type: "application/yaml" });
    const link = make("a", "", { href: URL.createObjectURL(file), download: "corrections.yaml" });
    link.click();
    URL.revokeObjectURL(link.href);
  });
  // entries in braces, as this page and the manual write them; names without quotes are put into some
  function readEntry(line) {
    const words = line.replace(/("(?:[^"\\]|\\.)*")|([{,[]\s*)([A-Za-z_]\w*)(?=\s*:)|(:\s*)([A-Za-z_][^,{}[\]"]*?)(?=\s*[,}])/g,
      (all, quoted, before, key, colon, value) => quoted ?? (key ? `${before}"${key}"` : `${colon}"${value}"`));
    const entry = JSON.parse(words);
    if (typeof entry.element !== "string" || !["at", "line", "outline"].some((key) => Array.isArray(entry[key]))) throw new Error("no entry");
    return entry;
  }
  function read(text) {
    const found = [];
    for (const [i, line] of text.split(/\r?\n/).entries()) {
      const content = line.replace(/^\s*-\s*/, "");
      const survey = /^survey:\s*"?(.*?)"?\s*$/.exec(line);
      if (survey && data.survey && survey[1] !== data.survey) {
        return tell(`These corrections are of ${survey[1]}, this page is of ${data.survey}: nothing was taken over.`, true);
      }
      if (survey || /^\s*(#.*|corrections:\s*)?$/.test(line)) continue;
      try {
        found.push(readEntry(content));
      } catch {
        return tell(`Line ${i + 1} is no entry in braces: nothing was taken over. Put the file beside the recording and run again.`, true);
      }
    }
    found.forEach(edits.bring);
    tell(`${edits.count(found.length, "entry").replace("entrys", "entries")} taken over.`);
  }
  byId("import").addEventListener("change", async () => {
    const [file] = byId("import").files;
    if (!file) return;
    if (file.size > 2 ** 18) tell(`${file.name} has ${file.size} bytes, at most ${2 ** 18} are read.`, true);
    else read(await file.text());
    byId("import").value = "";
  });

  // --- with a server ---
  async function connect() {
    if (location.protocol !== "http:" || server.watch) return;
    const known = server.revision;
    try {
      const state = await server.ask("state");
      if (server.revision !== known) return; // saved meanwhile: this is of before
      // reports of other storeys lie beside what is served
      byId("storeys")?.toggleAttribute("hidden", true);
      if (state.status !== 200) return tell(state.error, true);
      server.revision = state.revision;
      byId("save").hidden = false;
      byId("by-hand").hidden = true;
      if (state.page !== data.made) tell("The results are newer than this page: reload it. Your changes are kept.", true);
      edits.adopt(state.entries, state.revision);
      if (state.running || state.broken) watch();
    } catch {
      tell("The server does not answer: changes are kept in this browser.", true);
    }
  }
  byId("save").addEventListener("click", async () => {
    byId("save").disabled = true;
    faults.clear();
    const entries = edits.entries();
    try {
      const answer = await server.ask("corrections", { survey: data.survey, revision: server.revision, entries });
      if (answer.status === 409 && answer.entries) {
        server.revision = answer.revision;
        edits.adopt(answer.entries, answer.revision);
        tell(`${answer.error} Yours are kept beside them: save again.`, true);
      } else if (answer.status !== 200) {
        fail(answer.error, entries);
      } else {
        server.revision = answer.revision;
        edits.know(answer.revision);
        return watch();
      }
    } catch {
      tell("The server does not answer: changes are kept in this browser.", true);
    }
    list();
  });
  // what cannot be carried out is marked; the rest waits with it, and nothing is lost
  function fail(line, entries) {
    const words = faults.take(line, entries);
    tell(words === line || !words ? words : `${words}. Take it back or say it otherwise, then save again: all else is kept.`, Boolean(words));
    edits.begin();
  }
  async function watch() {
    const mine = (server.watch = {});
    const bar = byId("run-progress");
    for (;;) {
      const run = await server.ask("run").catch(() => ({ error: "The server does not answer; reload later." }));
      if (server.watch !== mine) return;
      const isOver = Boolean(run.error || !run.running);
      const left = run.running && run.left_s >= 1 ? `, about ${Math.round(run.left_s)} s left` : "";
      server.isBroken = Boolean(run.error || run.stopped);
      if (run.error) fail(run.error, run.entries ?? []);
      else tell(`${run.line}${left}`);
      // nothing moves under a pointer where nothing runs
      bar.hidden = byId("run-stop").hidden = isOver;
      byId("run-go").hidden = !(isOver && run.stopped);
      if (run.total) { bar.max = run.total; bar.value = run.ended; }
      if (isOver) {
        server.watch = undefined;
        byId("save").disabled = false;
        if (!run.error && !run.stopped) location.reload();
        return;
      }
      await new Promise((wait) => setTimeout(wait, 400));
    }
  }
  const act = async (what) => {
    try {
      const answer = await server.ask(what, {});
      if (answer.status !== 200) tell(answer.error, true);
    } catch {
      tell("The server does not answer: changes are kept in this browser.", true);
    }
  };
  byId("run-stop").addEventListener("click", () => act("stop"));
  byId("run-go").addEventListener("click", () => act("go").then(watch));
  if (edits.news) tell(edits.news);
  else if (!edits.keeps()) tell("This browser keeps nothing of this page: download before you close it.", true);
  edits.begin();
  connect();
  addEventListener("focus", connect);
})();
