import assert from "node:assert/strict";
import { test } from "node:test";
import { dressed, readGlb } from "../../../service/page/src/viewer/glb";

const POSITIONS = [0, 0, 0, 1, 0, 0, 0, 1, 0];
const HALF_TURN = Math.SQRT1_2;

function glb(extra: object): ArrayBuffer {
  const document = {
    accessors: [
      { bufferView: 0, componentType: 5126, count: 3, type: "VEC3" },
      { bufferView: 1, componentType: 5126, count: 3, type: "SCALAR" },
      { bufferView: 2, componentType: 5123, count: 3, type: "SCALAR" },
    ],
    bufferViews: [
      { byteOffset: 0, byteLength: 36 },
      { byteOffset: 36, byteLength: 12 },
      { byteOffset: 48, byteLength: 6 },
    ],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 0, _SPECULARITY: 1 }, indices: 2 }] }],
    nodes: [{ name: "body" }],
    ...extra,
  };
  let text = JSON.stringify(document);
  text += " ".repeat((4 - (text.length % 4)) % 4);
  const content = new ArrayBuffer(12 + 8 + text.length + 8 + 56);
  const view = new DataView(content);
  [0x46546c67, 2, content.byteLength, text.length, 0x4e4f534a].forEach((value, i) => view.setUint32(4 * i, value, true));
  new Uint8Array(content, 20).set(new TextEncoder().encode(text));
  const start = 20 + text.length + 8;
  [...POSITIONS, 0.25, 0.5, 0.75].forEach((value, i) => view.setFloat32(start + 4 * i, value, true));
  [2, 1, 0].forEach((value, i) => view.setUint16(start + 48 + 2 * i, value, true));
  return content;
}

test("arrays are read from where the document says, absent ones are null", () => {
  const body = readGlb(glb({}));
  assert.deepEqual([...body.positions], POSITIONS);
  assert.deepEqual([...body.specularity!], [0.25, 0.5, 0.75]);
  assert.deepEqual([...body.triangles], [2, 1, 0]);
  assert.equal(body.colours, null);
  assert.equal(body.camera, null);
  assert.equal(body.light, null);
});

test("a directional light is read as the way toward it", () => {
  const extras = { ambient: 0.1, specular_exponent: 12, colour_scale: 1.5 };
  const body = readGlb(
    glb({
      nodes: [{ name: "light", rotation: [0, HALF_TURN, 0, HALF_TURN] }],
      extensions: { KHR_lights_punctual: { lights: [{ type: "directional", extras }] } },
    }),
  );
  // A quarter turn about y takes +z to +x.
  assert.ok(body.light!.vector.every((value, i) => Math.abs(value - [1, 0, 0][i]!) < 1e-12));
  assert.equal(body.light!.colourScale, 1.5);
});

test("a texture is read with its places, and whether its light is in it", async () => {
  const attributes = { POSITION: 0, NORMAL: 0, TEXCOORD_0: 1 };
  const body = readGlb(
    glb({
      meshes: [{ primitives: [{ attributes, indices: 2 }] }],
      materials: [{ extensions: { KHR_materials_unlit: {} } }],
      images: [{ bufferView: 2, mimeType: "image/png" }],
    }),
  );
  assert.deepEqual([...body.uv!], [0.25, 0.5, 0.75]);
  assert.equal(body.unlit, true);
  assert.equal(body.texture!.type, "image/png");
  assert.deepEqual([...new Uint8Array(await body.texture!.arrayBuffer())], [2, 0, 1, 0, 0, 0]);
  assert.equal(readGlb(glb({})).texture, null);
});

test("a body wears the texture of another of the same mesh, cut along its seams", () => {
  const plain = readGlb(glb({}));
  const uv = Float32Array.of(0, 0, 0.5, 0, 1, 0, 0, 1);
  const skin = { ...plain, uncut: Float32Array.of(0, 1, 2, 1), uv, triangles: Uint16Array.of(0, 1, 2, 2, 3, 0) };
  const worn = dressed(plain, skin);
  assert.deepEqual([...worn.positions], [...POSITIONS, ...POSITIONS.slice(3, 6)]);
  assert.equal(worn.uv, uv);
  assert.equal(worn.triangles, skin.triangles);
  assert.equal(dressed(plain, plain), plain);
});

test("what is no GLB file is refused", () => {
  assert.throws(() => readGlb(new ArrayBuffer(40)), /no GLB/);
});
