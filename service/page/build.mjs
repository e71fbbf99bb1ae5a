// Bundles src/ into a folder of files that are served as they are: `node build.mjs [FOLDER]`.
// The same sources give the same bytes: a test builds anew and compares.
import { readFile, readdir, rm, writeFile, mkdir } from "node:fs/promises";
import { createHash } from "node:crypto";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2] ?? join(here, "dist");
const FONT = "@fontsource-variable/ibm-plex-sans/files/ibm-plex-sans-latin-wght-normal.woff2";
const LICENCES = ["preact", "@preact/signals", "@preact/signals-core", "three", "@fontsource-variable/ibm-plex-sans"];

await rm(folder, { recursive: true, force: true });
await mkdir(folder, { recursive: true });

const { metafile } = await build({
  absWorkingDir: here,
  entryPoints: { page: "src/main.tsx", style: "src/ui/style.css" },
  outdir: folder,
  bundle: true,
  minify: true,
  splitting: true,
  format: "esm",
  target: ["es2022"],
  jsx: "automatic",
  jsxImportSource: "preact",
  alias: { "plex-sans.woff2": join(here, "node_modules", FONT) },
  loader: { ".woff2": "file", ".webp": "file", ".bin": "binary" },
  entryNames: "[name].[hash]",
  chunkNames: "[name].[hash]",
  assetNames: "[name].[hash]",
  publicPath: "/page",
  legalComments: "none",
  metafile: true,
});

const outputs = Object.entries(metafile.outputs).map(([path, output]) => ({
  name: path.split("/").pop(),
  entry: output.entryPoint,
  imports: output.imports,
}));
const entry = (point) => outputs.find((output) => output.entry === point);
const script = entry("src/main.tsx");
const eager = script.imports.filter((each) => each.kind === "import-statement");
const font = outputs.find((output) => output.name.endsWith(".woff2"));

const index = (await readFile(join(here, "src/index.html"), "utf8"))
  .replace("{{style}}", entry("src/ui/style.css").name)
  .replace("{{script}}", script.name)
  .replace("{{font}}", font.name)
  .replace("{{preload}}", eager.map((each) => `<link rel="modulepreload" href="/page/${each.path.split("/").pop()}">`).join(""));
await writeFile(join(folder, "index.html"), index);
await writeFile(join(folder, "THIRD_PARTY.txt"), await thirdParty());

const weights = new Map();
for (const name of (await readdir(folder)).sort()) {
  const content = await readFile(join(folder, name));
  const packed = /\.(woff2|webp)$/.test(name) ? content.length : gzipSync(content, { level: 9 }).length;
  weights.set(name, packed);
  const digest = createHash("sha256").update(content).digest("hex").slice(0, 8);
  console.log(`${String(packed).padStart(8)} bytes gzipped  ${digest}  ${name}`);
}
const total = (names) => String([...names].reduce((sum, name) => sum + weights.get(name), 0)).padStart(8);
const byName = new Map(outputs.map((output) => [output.name, output]));
/** A module's file with all that is loaded along with it. */
const loaded = (name) => [
  name,
  ...byName
    .get(name)
    .imports.filter((each) => each.kind === "import-statement")
    .flatMap((each) => loaded(each.path.split("/").pop())),
];
const assets = [...weights.keys()].filter((name) => /\.(html|css|woff2|webp)$/.test(name));
const points = ["src/main.tsx", "src/panel/Workbench.tsx", "src/viewer/BodyScene.ts"];
const names = new Set([...assets, ...points.flatMap((point) => loaded(entry(point).name))]);
console.log(`${total(weights.keys())} bytes gzipped in all`);
console.log(`${total(names)} bytes gzipped before a first result`);

async function thirdParty() {
  const texts = [];
  for (const name of LICENCES) {
    const root = join(here, "node_modules", name);
    const { version } = JSON.parse(await readFile(join(root, "package.json"), "utf8"));
    const licence = await readFile(join(root, "LICENSE"), "utf8");
    texts.push(`${name} ${version}\n${"=".repeat(72)}\n\n${licence.trim()}\n`);
  }
  return texts.join("\n\n");
}
