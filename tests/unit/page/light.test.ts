import assert from "node:assert/strict";
import { test } from "node:test";
import { lightAt } from "../../../service/page/src/panel/ball";

test("a ball lit in its middle is lit by the camera's side, at its rim from aside", () => {
  const { azimuth_deg, elevation_deg } = lightAt(0, 0);
  assert.ok(Math.hypot(azimuth_deg, elevation_deg) < 1e-9);
  assert.ok(Math.abs(lightAt(1, 0).azimuth_deg - 90) < 1e-9);
  assert.ok(Math.abs(lightAt(0, -1).elevation_deg - 90) < 1e-9);
});

test("right is positive azimuth, up is positive elevation, beyond the rim is the rim", () => {
  const { azimuth_deg, elevation_deg } = lightAt(-0.3, 0.4);
  assert.ok(azimuth_deg < 0 && elevation_deg < 0);
  assert.ok(Math.abs(lightAt(30, 0).azimuth_deg - 90) < 1e-9);
});
