// Words in a component are found wherever they would be shown, and only there.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";

/** What is found in a component that returns this. */
function foundIn(jsx: string): string[] {
  const folder = mkdtempSync(join(tmpdir(), "literals-"));
  try {
    writeFileSync(join(folder, "Planted.tsx"), `export const Planted = ({ a, words }: any) => ${jsx};\n`);
    const { status, stderr } = spawnSync(process.execPath, ["literals.mjs", folder], { encoding: "utf8" });
    const found = [...stderr.matchAll(/Planted\.tsx:1: (".*") belongs/g)].map((each) => JSON.parse(each[1]!) as string);
    assert.equal(status, found.length > 0 ? 1 : 0, stderr);
    return found;
  } finally {
    rmSync(folder, { recursive: true });
  }
}

test("text between tags is found, also beside other things", () => {
  assert.deepEqual(foundIn("<p>Hello {words.you} again</p>"), ["Hello", "again"]);
});

test("what labels, titles and places for input say is found", () => {
  assert.deepEqual(foundIn('<input aria-label="Name" title={a ? "One" : words.two} placeholder={`about ${a}`} />'), ["Name", "One", "about …"]);
});

test("what an expression may come to is found, options of a choice too", () => {
  assert.deepEqual(foundIn('<p>{a && "Yes"}{a ?? "None"}{a + " px"}</p>'), ["Yes", "None", "px"]);
  assert.deepEqual(foundIn('<Choice options={[{ value: "one", label: "First" }]} />'), ["First"]);
});

test("nothing else is taken for words", () => {
  assert.deepEqual(foundIn('<p class="fine">{a === "SES" ? words.yes : call("name")} 12 × 3 – <code>maquette keys</code></p>'), []);
  assert.deepEqual(foundIn('<a class={a ? "is-open" : ""} href="#/">{" "}Maquette</a>'), []);
});
