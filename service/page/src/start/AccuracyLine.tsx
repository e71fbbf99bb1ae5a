// How good it is, in one sentence with its figure.
import { girthErrors, PAIR, PEOPLE } from "../accuracy/figures";
import { decimal, measured } from "../messages/figures";
import { messages } from "../messages";
import { ACCURACY_ADDRESS } from "../route";

/** Told to half a centimetre, upward: the figure is a mean, and a promise. */
const STEPS_PER_CM = 2;

export function AccuracyLine() {
  const { start } = messages;
  const [, most] = girthErrors(PAIR.frontAndSide);
  return (
    <p>
      {start.accuracy(measured(Math.ceil(STEPS_PER_CM * most) / STEPS_PER_CM, "centimeter", 1), decimal(PEOPLE))}{" "}
      <a href={ACCURACY_ADDRESS}>{start.figures}</a>
    </p>
  );
}
