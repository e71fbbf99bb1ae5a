// How good it is, in one sentence with its figure.
import { girthErrors, PAIR, PEOPLE } from "../accuracy/figures";
import { decimal, measured } from "../messages/figures";
import { messages } from "../messages";
import { ACCURACY_ADDRESS } from "../route";

export function AccuracyLine() {
  const { start } = messages;
  const [least, most] = girthErrors(PAIR.frontAndSide);
  return (
    <p class="lead">
      {start.accuracy(decimal(least, 1), measured(most, "centimeter", 1), decimal(PEOPLE))}{" "}
      <a href={ACCURACY_ADDRESS}>{start.figures}</a>
    </p>
  );
}
