import assert from "node:assert/strict";
import { test } from "node:test";
import type { Problem } from "../../../service/page/src/api/types";
import { faultsOfPlaces, isErased, isUnusable, viewNamedFirst, withViews } from "../../../service/page/src/measure/faults";
import { placesOf } from "../../../service/page/src/measure/places";
import { plainly } from "../../../service/page/src/measure/plainly";
import { proposedText } from "../../../service/page/src/measure/proposed";
import { proposedOf, proposedText as onePictureText } from "../../../service/page/src/ui/proposed";
import { viewLabels, viewTitles } from "../../../service/page/src/measure/views";

function problem(...errors: readonly { field: string; code: string }[]): Problem {
  return {
    type: "/problems/unusable-input",
    title: "What was sent cannot be used",
    status: 422,
    detail: "",
    code: errors[0]!.code,
    remedy: "",
    field: errors[0]!.field,
    instance: null,
    errors: errors.map((error) => ({ ...error, reason: error.code, remedy: "" })),
  };
}

const views = (...kinds: readonly string[]) => kinds.map((view) => ({ view }));

test("each view has the place of its name, wherever it stands in the scan", () => {
  assert.deepEqual(placesOf(views("front", "side")), ["front", "side"]);
  assert.deepEqual(placesOf(views("side", "front")), ["side", "front"]);
  assert.deepEqual(placesOf(views("side", "back", "side", "front")), ["side", null, null, "front"]);
});

test("a fault is told at the picture of its view, not at that of its number", () => {
  const nobody = problem({ field: "views.0.points", code: "person-not-found" });
  const { places, rest } = faultsOfPlaces(nobody, placesOf(views("side", "front")));
  assert.deepEqual([...places.keys()], ["side"]);
  assert.equal(places.get("side")!.errors![0]!.field, "points");
  assert.equal(rest, null);
});

test("a fault of a picture that has no place here is told nowhere, one of the scan is left", () => {
  const both = problem({ field: "views.1.image", code: "image-damaged" }, { field: "height_m", code: "out-of-range" });
  const { places, rest } = faultsOfPlaces(both, placesOf(views("front", "back", "side")));
  assert.equal(places.size, 0);
  assert.deepEqual(rest!.errors!.map(({ field }) => field), ["height_m"]);
});

test("what was erased can be sent anew, what is damaged cannot", () => {
  const erased = problem({ field: "image_id", code: "unknown-image" });
  assert.ok(isErased(erased) && !isUnusable(erased));
  const damaged = problem({ field: "image", code: "image-damaged" });
  assert.ok(!isErased(damaged) && isUnusable(damaged));
  assert.ok(!isUnusable({ ...damaged, status: 503 }));
});

test("warnings name pictures, not places in a request", () => {
  const message = "views.1 is said to be from the side. Check views.0 and the chest_girth. views.1 is mirrored.";
  assert.equal(
    withViews(message, views("front", "side")),
    "The side picture is said to be from the side. Check the front picture and the chest girth. The side picture is mirrored.",
  );
  assert.equal(withViews("views.7 is missing.", views("front", "side")), "views.7 is missing.");
});

test("a warning about one view begins with it", () => {
  assert.equal(viewNamedFirst("views.1 is said to be from the side."), 1);
  assert.equal(viewNamedFirst("The body in views.1 differs."), null);
});

test("people who click nothing are told nothing of points", () => {
  for (const code of ["several-people", "ambiguous-limb-facing", "low-silhouette-overlap"]) {
    assert.doesNotMatch(plainly("warnings", code)!, /click|point(s)\b|mask|“/i, code);
  }
  assert.match(plainly("faults", "person-not-found")!, /Nobody/);
  assert.match(plainly("faults", "image-damaged")!, /damaged/);
  assert.equal(plainly("faults", "image-too-small"), null);
});

test("pictures of the same side are told apart by numbers, others by their names alone", () => {
  const seen = (["front", "side", "side"] as const).map((view) => ({ view }));
  assert.deepEqual(viewLabels(seen), ["Front", "Side 1", "Side 2"]);
  assert.deepEqual(viewTitles(seen), ["The front picture", "The side picture 1", "The side picture 2"]);
});

test("proposed points are counted, not named", () => {
  type Seen = Parameters<typeof proposedText>[0][number];
  const seen = (number: number, view: Seen["view"], value: string | null): Seen => ({
    number,
    view,
    assumptions: value === null ? [] : [{ quantity: "points", value, reason: "" }],
  });
  type Asked = Parameters<typeof proposedText>[1];
  const asked = (...clicked: readonly object[]) => ({ views: clicked.map((points) => ({ points })) }) as unknown as Asked;
  const both = [seen(0, "front", "nose, left_hip"), seen(1, "side", "nose")];
  assert.match(proposedText(both, asked({}, {}))!, /^All points were found/);
  const some = proposedText(both, asked({ chin: {} }, {}))!;
  // Proposals that were sent back are no clicks.
  assert.match(proposedText(both, asked({ nose: {}, left_hip: {} }, {}))!, /^All points were found/);
  assert.match(some, /2 of the front picture, all of the side picture/);
  assert.doesNotMatch(some, /nose|left/);
  assert.equal(proposedText([seen(0, "front", null), seen(1, "side", null)], asked({ nose: {} }, { nose: {} })), null);
});

test("a fit tells of its proposed points as a scan does, and how many while its request is not known", () => {
  const assumed = [{ quantity: "points", value: "nose, left_hip", reason: "" }];
  const told = (asked: unknown) => onePictureText(proposedOf(assumed, asked)!);
  assert.match(told({}), /^All points were found/);
  assert.match(told({ chin: {} }), /^2 points were found/);
  assert.match(told(null), /^2 points were found/);
  assert.equal(proposedOf([], {}), null);
});
