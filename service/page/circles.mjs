// Finds modules that import each other in a circle, types included: `node circles.mjs` names each circle and fails.
import { readFile, readdir } from "node:fs/promises";
import { dirname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";

const SOURCES = join(dirname(fileURLToPath(import.meta.url)), "src");
const IMPORT = /(?:from|import)\s*\(?\s*"(\.[^"]*)"/g;

const names = (await readdir(SOURCES, { recursive: true })).filter((name) => /\.tsx?$/.test(name));
const imports = new Map();
for (const name of names) {
  const text = await readFile(join(SOURCES, name), "utf8");
  imports.set(name, [...text.matchAll(IMPORT)].flatMap(([, path]) => resolved(normalize(join(dirname(name), path))) ?? []));
}
const done = new Set();
for (const name of names) walk(name, []);

function resolved(path) {
  return [`${path}.ts`, `${path}.tsx`, join(path, "index.ts")].find((each) => names.includes(each));
}

function walk(name, way) {
  const at = way.indexOf(name);
  if (at >= 0) {
    console.error([...way.slice(at), name].join(" -> "));
    process.exitCode = 1;
    return;
  }
  if (done.has(name)) return;
  for (const next of imports.get(name)) walk(next, [...way, name]);
  done.add(name);
}
