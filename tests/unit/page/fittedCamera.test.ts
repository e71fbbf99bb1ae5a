import assert from "node:assert/strict";
import { test } from "node:test";
import { PerspectiveCamera, Vector3 } from "three";
import { Emerging, fittedProjection } from "../../../service/page/src/viewer/fittedCamera";

const CAMERA = { fx: 900, cx: 300, cy: 520, width: 720, height: 960 };
const POINT = new Vector3(0.3, -0.2, -3);

/** Pixels of the picture. */
const PIXEL = [CAMERA.cx + (CAMERA.fx * 0.3) / 3, CAMERA.cy + (CAMERA.fx * 0.2) / 3] as const;

test("a point lies on the picture where the camera saw it, in the middle of canvases of any shape", () => {
  for (const [width, height] of [[720, 960], [1600, 960], [720, 1500]] as const) {
    const { x, y } = POINT.clone().applyMatrix4(fittedProjection(CAMERA, width / height));
    const [left, top] = [(width - CAMERA.width) / 2, (height - CAMERA.height) / 2];
    assert.ok(Math.abs((0.5 + 0.5 * x) * width - left - PIXEL[0]) < 1e-6);
    assert.ok(Math.abs((0.5 - 0.5 * y) * height - top - PIXEL[1]) < 1e-6);
  }
});

test("a body comes out of the picture, and is then where the other camera sees it", () => {
  const to = new PerspectiveCamera(30, 0.75, 0.02, 100);
  to.position.set(1, 0.2, 2);
  to.lookAt(0, 0, -3);
  to.updateMatrixWorld();
  const way = new Emerging(CAMERA, { upright: null });
  const seen = (now: number) => {
    const camera = way.at(now, to);
    camera.updateMatrixWorld();
    return POINT.clone().project(camera);
  };
  assert.ok(seen(5000).distanceTo(POINT.clone().applyMatrix4(fittedProjection(CAMERA, 0.75))) < 1e-6);
  assert.equal(way.isOver(5100), false);
  assert.ok(seen(9000).distanceTo(POINT.clone().project(to)) < 1e-6);
  assert.equal(way.isOver(9000), true);
});
