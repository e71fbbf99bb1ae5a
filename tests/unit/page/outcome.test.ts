import assert from "node:assert/strict";
import { test } from "node:test";
import { headingOf, isContradicted } from "../../../service/page/src/result/outcome";

test("a verdict against a person is the heading, whatever the outcome", () => {
  assert.equal(headingOf({ outcome: "poor_fit", verdict: "no_person" }), "No person found");
  assert.equal(headingOf({ outcome: "poor_fit", verdict: "implausible" }), "Not plausible");
  assert.equal(headingOf({ outcome: "poor_fit", verdict: "plausible" }), "A poor fit");
  assert.equal(headingOf({ outcome: "converged", verdict: "plausible" }), "The body");
});

test("a fit of an earlier version, which has no verdict, is taken for a person's", () => {
  assert.equal(headingOf({ outcome: "converged" }), "The body");
  assert.equal(isContradicted({}), false);
  assert.equal(isContradicted({ verdict: "no_person" }), true);
});
