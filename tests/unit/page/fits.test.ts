// A fit of one picture and a scan of several are one type to the page.
import assert from "node:assert/strict";
import { test } from "node:test";
import { askedOfFit, askedOfView, fitOfJob, fitOfScan, nameOfView, pathOf, resultOfFit, resultOfScan } from "../../../service/page/src/api/fits";
import type { Asked } from "../../../service/page/src/api/fits";
import type { FitOptions, FitResult, Job, Scan, ScanResult } from "../../../service/page/src/api/types";

const links = { self: "/v1/x", events: "/v1/x/events", request: "/v1/x/request" };
const job = { id: "1", state: "queued", label: "Ada", links: { ...links, image: "/i", mask: "/m" } } as Job;
const scan = { id: "2", state: "queued", label: "Ada", view: 1, links: { ...links, views: [{ image: "/0", mask: "/m" }, { image: "/1" }] } } as Scan;

test("of one picture or of several, the pictures stand in their order, each with its mask", () => {
  const [one, several] = [fitOfJob(job), fitOfScan(scan)];
  assert.deepEqual(one.pictures, [{ image: "/i", mask: "/m" }]);
  assert.deepEqual(several.pictures, [{ image: "/0", mask: "/m" }, { image: "/1" }]);
  for (const fit of [one, several]) assert.deepEqual(fit.links, links);
  assert.deepEqual([one.view, several.view], [null, 1]);
});

test("each is reached where the service has it, and has files of a picture by its names", () => {
  assert.equal(pathOf(fitOfJob(job)), "/v1/fits/1");
  assert.equal(pathOf(fitOfScan(scan)), "/v1/scans/2");
  assert.equal(nameOfView({ kind: "fit" }, "overlay.png", 0), "overlay.png");
  assert.equal(nameOfView({ kind: "scan" }, "body_posed_se.glb", 1), "body_posed_se_1.glb");
});

const stages = [{ name: "SE", measurements: [{ name: "stature" }] }];
const found = { cues: "SES", outcome: "converged", verdict: "implausible", silhouette_overlap: 0.9, stages, warnings: [{ code: "a" }], assumptions: [{ quantity: "b" }], limb_facing: [{ limb: "c" }], evaluations: 7, measurements: [] };

test("what a fit of one picture says of it stands with that picture, and nothing of it is said twice", () => {
  const result = resultOfFit(found as unknown as FitResult);
  assert.equal(result.agreement, null);
  assert.deepEqual([result.warnings, result.assumptions], [[], []]);
  const [view] = result.views;
  assert.deepEqual([view!.number, view!.view, view!.verdict, view!.findings], [0, null, "implausible", []]);
  assert.deepEqual([view!.warnings, view!.assumptions, view!.limb_facing], [found.warnings, found.assumptions, found.limb_facing]);
  assert.deepEqual(result.outlined, stages[0]!.measurements);
});

test("measurements by the outline alone are there only where shading followed", () => {
  assert.equal(resultOfFit({ ...found, cues: "SE" } as unknown as FitResult).outlined, null);
});

test("a fit of an earlier version, which has no verdict, is taken for a person's", () => {
  const { verdict: _, ...earlier } = found;
  const result = resultOfFit(earlier as unknown as FitResult);
  assert.deepEqual([result.verdict, result.views[0]!.verdict], ["plausible", "plausible"]);
});

test("a scan of an earlier version, which has no stages and no facings, is shown without them", () => {
  const earlier = { cues: "SES", views: [{ number: 0 }, { number: 1 }], agreement: 0.4 };
  const result = resultOfScan(earlier as unknown as ScanResult);
  assert.deepEqual([result.outlined, result.evaluations, result.energies], [null, 0, {}]);
  assert.deepEqual(result.views.map(({ limb_facing }) => limb_facing), [[], []]);
  const told = resultOfScan({ ...earlier, stages, views: [{ number: 0, limb_facing: ["c"] }] } as unknown as ScanResult);
  assert.deepEqual([told.outlined, told.views[0]!.limb_facing], [stages[0]!.measurements, ["c"]]);
});

test("what was asked of one picture comes back as it was sent, but for what is changed", () => {
  const options = { gender: "male", height_m: 1.8, cues: "SE", force: false, optimizer: "simplex", points: { nose: {} }, clothing: "loose" } as unknown as FitOptions;
  const asked = askedOfFit(options);
  assert.deepEqual(asked.views, [{ points: { nose: {} }, clothing: "loose" }]);
  assert.deepEqual(askedOfView({ ...asked, force: true }, 0), { ...options, force: true });
});

test("one picture of several is asked for as one alone would be", () => {
  const asked = { gender: "male", views: [{ view: "front", points: {} }, { view: "side", clothing: "loose" }] } as unknown as Asked;
  assert.deepEqual(askedOfView(asked, 1), { gender: "male", clothing: "loose" });
});
