import assert from "node:assert/strict";
import { test } from "node:test";
import { headingOf } from "../../../service/page/src/result/outcome";

const views = (...outcomes: readonly ("converged" | "poor_fit")[]) => outcomes.map((outcome) => ({ outcome }));

test("a verdict against a person is the heading, whatever the outcome", () => {
  assert.equal(headingOf({ verdict: "no_person", views: views("poor_fit") }), "No person found");
  assert.equal(headingOf({ verdict: "implausible", views: views("poor_fit") }), "Not plausible");
  assert.equal(headingOf({ verdict: "plausible", views: views("poor_fit") }), "A poor fit");
  assert.equal(headingOf({ verdict: "plausible", views: views("converged", "poor_fit") }), "A poor fit");
  assert.equal(headingOf({ verdict: "plausible", views: views("converged") }), "The body");
});
