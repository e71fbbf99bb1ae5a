import assert from "node:assert/strict";
import { test } from "node:test";
import { levelWord, tiltOf } from "../../../service/page/src/measure/level";

type Vector = readonly [number, number, number];

/** The phone's axes in the world (east, north, up), as columns: right, top and out of the screen. */
type Held = readonly [right: Vector, top: Vector, out: Vector];

const DEG = Math.PI / 180;

/** The phone upright before somebody who looks north: its screen faces south. */
const UPRIGHT: Held = [
  [1, 0, 0],
  [0, 0, 1],
  [0, -1, 0],
];

/** Turned like the hands of a clock, as seen by whoever looks at the screen. */
function turnedClockwise([right, top, out]: Held, degrees: number): Held {
  const [c, s] = [Math.cos(degrees * DEG), Math.sin(degrees * DEG)];
  return [mixed(c, right, -s, top), mixed(c, top, s, right), out];
}

/** Its top leans back, away from whoever looks at the screen, if its screen is as it is in portrait. */
function leantBack([right, top, out]: Held, degrees: number): Held {
  const turn = ([x, y, z]: Vector): Vector => {
    const [c, s] = [Math.cos(degrees * DEG), Math.sin(degrees * DEG)];
    return [x, c * y + s * z, c * z - s * y];
  };
  return [turn(right), turn(top), turn(out)];
}

function mixed(a: number, one: Vector, b: number, other: Vector): Vector {
  return one.map((each, index) => a * each + b * other[index]!) as unknown as Vector;
}

/** Beta and gamma of R = Rz(alpha) Rx(beta) Ry(gamma), gamma in [-90, 90), from the third row of R. */
function angles(held: Held): { beta: number; gamma: number } {
  const [x, y, z] = held.map(([, , up]) => up) as [number, number, number];
  // Rounding keeps cos(beta) from being a zero with a sign of its own.
  const flat = Math.hypot(x, z);
  if (flat < 1e-12) return { beta: y > 0 ? 90 : -90, gamma: 0 };
  const back = z < -1e-12 || (Math.abs(z) <= 1e-12 && x < 0) ? -1 : 1;
  const beta = Math.atan2(y, back * flat) / DEG;
  return { beta, gamma: Math.atan2(-back * x, back * z) / DEG };
}

function tilt(held: Held, screenAngle: number) {
  const { beta, gamma } = angles(held);
  return tiltOf(beta, gamma, screenAngle);
}

function near(actual: number, expected: number) {
  assert.ok(Math.abs(actual - expected) < 1e-6, `${actual} is not ${expected}`);
}

// What is shown stays upright: turned counterclockwise by 90 degrees a phone has the angle 90.
for (const screenAngle of [0, 90, 180, 270]) {
  const held = turnedClockwise(UPRIGHT, -screenAngle);

  test(`a phone held upright is level when its screen is turned by ${screenAngle}`, () => {
    const { roll, pitch } = tilt(held, screenAngle);
    near(roll, 0);
    near(pitch, 0);
    assert.equal(levelWord({ roll, pitch }, false), null);
  });

  test(`a roll clockwise is positive and asks for a turn to the left, at ${screenAngle}`, () => {
    const clockwise = tilt(turnedClockwise(held, 7), screenAngle);
    near(clockwise.roll, 7);
    assert.match(levelWord(clockwise, false)!, /to the left/);
    const counterclockwise = tilt(turnedClockwise(held, -7), screenAngle);
    near(counterclockwise.roll, -7);
    assert.match(levelWord(counterclockwise, false)!, /to the right/);
  });

  test(`a back that looks up or down is told, at ${screenAngle}`, () => {
    const back = tilt(leantBack(held, 10), screenAngle);
    near(back.roll, 0);
    near(back.pitch, 10);
    assert.match(levelWord(back, false)!, /looks down/);
    assert.match(levelWord(back, true)!, /looks up/);
    const forward = tilt(leantBack(held, -10), screenAngle);
    near(forward.pitch, -10);
    assert.match(levelWord(forward, false)!, /looks up/);
    assert.match(levelWord(forward, true)!, /looks down/);
  });
}

test("angles as the specification writes them: near upright beta is near 90 and gamma may be anything", () => {
  near(tiltOf(90, 0, 0).roll, 0);
  near(tiltOf(90, 45, 0).roll, 0);
  // Rolled clockwise by five degrees: beta 95 and gamma -90, since gamma ends below 90.
  near(tiltOf(95, -90, 0).roll, 5);
  near(tiltOf(85, -90, 0).roll, -5);
  // In landscape, turned counterclockwise: gamma is -90. The top of the phone is at the left; raised, it has a beta.
  near(tiltOf(0, -90, 90).roll, 0);
  near(tiltOf(5, -90, 90).roll, 5);
  near(tiltOf(-5, -90, 90).roll, -5);
  near(tiltOf(0, 89.9999999, 270).roll, 0);
});
