// Runs the tests of the page's modules (tests/unit/page/*.test.ts) with Node's own runner.
import { readdir, rm, mkdtemp } from "node:fs/promises";
import { spawnSync } from "node:child_process";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const tests = join(here, "../../tests/unit/page");
const folder = await mkdtemp(join(tmpdir(), "page-tests-"));
try {
  const names = (await readdir(tests)).filter((name) => name.endsWith(".test.ts"));
  await build({
    entryPoints: names.map((name) => join(tests, name)),
    outdir: folder,
    outExtension: { ".js": ".mjs" },
    bundle: true,
    platform: "node",
    format: "esm",
    target: "node20",
    loader: { ".bin": "binary" },
    nodePaths: [join(here, "node_modules")],
    // What a browser has and Node has not.
    banner: { js: "globalThis.sessionStorage ??= { getItem: () => null };" },
    logLevel: "warning",
  });
  const files = names.map((name) => join(folder, name.replace(".ts", ".mjs")));
  const { status } = spawnSync(process.execPath, ["--test", ...files], { stdio: "inherit" });
  process.exitCode = status ?? 1;
} finally {
  await rm(folder, { recursive: true });
}
