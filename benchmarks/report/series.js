// Rows to curves: one per technique over its quality parameter.

/** Name to value, the environment's lights included; texts all. */
export function settings(row) {
  const all = {...row.parameters};
  if (row.environment_lights) all["environment lights"] = String(row.environment_lights);
  if (row.environment_settings) all["environment settings"] = row.environment_settings;
  return all;
}

/** A technique's own parameters go without its name before them. */
export function ownName(row, name) {
  const own = row.technique.split(":", 1)[0] + ".";
  return name.startsWith(own) && !row.technique.includes(",") ? name.slice(own.length) : name;
}

/** Tells rows that another version measured, which outdatedText() explains. */
export const OUTDATED = " †";

/** What a row is called in tables. */
export const markedTitle = (row) => `${row.title || row.technique}${row.outdated ? OUTDATED : ""}`;

/** What the mark says, where a row has it. */
export const outdatedText = (rows) => (rows.some((row) => row.outdated)
  ? "† measured with another version of the program, of a technique or of the scene than the newest row. " : "");

/** "samples=16 bias=2" */
export function settingsText(row, names = null) {
  return Object.entries(settings(row)).filter(([name]) => !names || names.includes(name))
    .map(([name, value]) => `${ownName(row, name)}=${value}`).join(" ");
}

/** Whether a parameter trades error for time; rows of earlier versions do not say: numbers do. */
function isQuality(row, name) {
  if (name === "environment lights") return true;
  if (row.quality_parameters?.length) return row.quality_parameters.includes(name);
  return !Number.isNaN(Number(settings(row)[name]));
}

const distinct = (values) => new Set(values).size;

/** Parameters of `rows` with several values, those that step together as one group, the longest sweep first. */
function sweeps(rows) {
  const names = [...new Set(rows.flatMap((row) => Object.keys(settings(row))))]
    .filter((name) => isQuality(rows[0], name) && distinct(rows.map((row) => settings(row)[name])) > 1);
  const groups = [];
  for (const name of names) {
    const values = (other) => rows.map((row) => settings(row)[other]);
    const count = distinct(values(name));
    const together = groups.find(([first]) => distinct(values(first)) === count &&
      distinct(rows.map((row) => settings(row)[first] + "\n" + settings(row)[name])) === count);
    if (together) together.push(name);
    else groups.push([name]);
  }
  return groups.sort((a, b) => distinct(rows.map((row) => settings(row)[b[0]])) -
                               distinct(rows.map((row) => settings(row)[a[0]])));
}

export function groupBy(items, key) {
  const groups = new Map();
  for (const item of items) groups.set(key(item), [...(groups.get(key(item)) ?? []), item]);
  return groups;
}

/**
 * A parameter's number, its default where the row sets none. 0 where that is not known: an environment without lights, rows of
 * earlier versions.
 */
const numberOf = (row, name) => Number(settings(row)[name] ?? row.all_parameters?.[name] ?? 0);

/** Lines of rows in which one parameter (or several in step) rises. */
function lines(rows) {
  const [swept = [], ...fixed] = sweeps(rows);
  const others = fixed.flat();
  return [...groupBy(rows, (row) => settingsText(row, others)).values()]
    .map((line) => [...line].sort((a, b) => numberOf(a, swept[0]) - numberOf(b, swept[0])));
}

export const SEPARATION_FLOOR = "separation_floor";

/** [{name, index, rows, lines}]; the index chooses colour, marker and dashes. */
export function curves(rows) {
  const answered = rows.filter((row) => !row.failure && row.technique !== SEPARATION_FLOOR);
  const result = [];
  for (const ofTechnique of groupBy(answered, (row) => row.technique + "\n" + row.title).values()) {
    const kind = (row) => Object.keys(settings(row)).filter((name) => !isQuality(row, name));
    const differing = [...new Set(ofTechnique.flatMap(kind))]
      .filter((name) => distinct(ofTechnique.map((row) => settings(row)[name])) > 1);
    for (const same of groupBy(ofTechnique, (row) => settingsText(row, differing)).values()) {
      const name = [same[0].title || same[0].technique, settingsText(same[0], differing)].filter(Boolean).join(" ");
      result.push({name, index: result.length, rows: same, lines: lines(same)});
    }
  }
  return result;
}

/** The curve a row belongs to. */
export function curveOf(all, row) {
  return all.find((curve) => curve.rows.includes(row));
}
