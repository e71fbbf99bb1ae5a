import assert from "node:assert/strict";
import { test } from "node:test";
import { skinAmong } from "../../../service/page/src/derived/skin";

type Texture = Parameters<typeof skinAmong<{ id: string; state: "queued" | "succeeded" | "failed" }>>[0][number];

const texture = (id: string, state: "queued" | "succeeded" | "failed", colours: "picture" | "albedo" | "own" = "picture", size: 512 | 1024 = 1024): Texture => ({
  job: { id, state },
  asked: { kind: "texture", colours, size },
});

test("textures of other colours or sizes are no skin", () => {
  assert.equal(skinAmong([texture("painted", "succeeded", "own"), texture("unlit", "succeeded", "albedo"), texture("small", "succeeded", "picture", 512)]), null);
});

test("the first that succeeded is the skin, before what is on its way and what failed", () => {
  const first = texture("first", "succeeded");
  assert.equal(skinAmong([texture("again", "succeeded"), first, texture("older", "failed")])!.id, "first");
  assert.equal(skinAmong([texture("coming", "queued"), texture("older", "failed")])!.id, "coming");
  assert.equal(skinAmong([texture("older", "failed")])!.id, "older");
});
