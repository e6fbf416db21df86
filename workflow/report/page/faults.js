// what was said and cannot be carried out: told in its own words, and marked where it is until it is taken back or said otherwise
const faults = (() => {
  const { data, lookAt, say } = planView;
  const ENTRY = /\bentry (\d+)\b/g; // stages name an entry by its number in the file, which no page shows
  const why = new Map(); // by what is said
  const inWords = (line, entries) => line.replace(ENTRY, (number, n) => (entries[n - 1] ? `“${choices.describe(entries[n - 1])}”` : number));
  // returns what is to be told: nothing where all that a line names was taken back since
  function take(line, entries) {
    const named = [...line.matchAll(ENTRY)].map(([, n]) => entries[n - 1]).filter(Boolean);
    if (!named.length) return line;
    const [, subject, reason] = /(\bentry \d+): (.*?)(: not applied)?$/s.exec(line).slice(0, 3).map((part) => inWords(part, entries));
    const here = named.filter(edits.has);
    for (const entry of here) why.set(edits.tell(entry), reason);
    return here.length ? `${subject}: ${reason}` : "";
  }
  const of = (entry) => why.get(edits.tell(entry));
  function show(entry) {
    const [x, y] = edits.spotOf(entry);
    lookAt({ x, y: -y });
    planView.view.scrollIntoView({ block: "nearest" });
    say(of(entry), 6);
  }
  for (const line of document.querySelectorAll("header [role=alert]")) line.textContent = inWords(line.textContent, data.corrections);
  for (const line of data.unmatched) take(line, data.corrections);
  return { take, of, show, clear: () => why.clear() };
})();
