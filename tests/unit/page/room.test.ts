import assert from "node:assert/strict";
import { test } from "node:test";
import { roomLink } from "../../../service/page/src/result/room";

const GLB = "/v1/fits/1/artifacts/body_canonical.glb";
const DESK = { followsAr: false, isAndroid: false, page: "https://bodies.example/", needsKey: false };

test("a desk has no room to show a body in", () => {
  assert.equal(roomLink(GLB, DESK), null);
});

test("iOS follows a link to the USDZ file", () => {
  const link = roomLink(GLB, { ...DESK, followsAr: true });
  assert.deepEqual(link, { href: "/v1/fits/1/artifacts/body_canonical.usdz", rel: "ar" });
});

test("the viewer of Android is given the whole address, and only by https", () => {
  const link = roomLink(GLB, { ...DESK, isAndroid: true });
  assert.match(link!.href, /^intent:\/\/arvr\.google\.com\/scene-viewer\/1\.0\?file=https%3A%2F%2Fbodies\.example%2Fv1/);
  assert.equal(roomLink(GLB, { ...DESK, isAndroid: true, page: "http://192.168.0.2:8000/" }), null);
});

test("what needs a key is fetched by nobody else", () => {
  assert.equal(roomLink(GLB, { ...DESK, followsAr: true, needsKey: true }), null);
});
