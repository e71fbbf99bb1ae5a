// What nobody said and had to be assumed.
import type { InitialPose } from "../api/types";
import { person } from "../draft/draft";
import { heightInWords } from "../draft/person";
import { measured } from "../messages/figures";
import { messages } from "../messages";
import { fieldName } from "./answered";
import { PROPOSED_POINTS, proposedOf, proposedText } from "./proposed";

export type Assumptions = InitialPose["assumptions"];

const TOLD = "outline";

interface Props {
  readonly assumptions: Assumptions;
  /** The points of the request; null while they are not known. */
  readonly asked: unknown;
}

export function AssumptionNotes({ assumptions, asked }: Props) {
  const proposed = proposedOf(assumptions, asked);
  return (
    <>
      {assumptions.map((assumption) => (
        <p class="note" key={assumption.quantity}>
          {proposed && assumption.quantity === PROPOSED_POINTS ? proposedText(proposed) : <Assumed assumption={assumption} />}
        </p>
      ))}
    </>
  );
}

function Assumed({ assumption: { quantity, value, reason } }: { assumption: Assumptions[number] }) {
  const { assumed } = messages.frame;
  if (quantity === "focal_length_35mm" && typeof value === "number") return <>{assumed.lens(measured(value, "millimeter"))}</>;
  if (quantity === "height_m" && typeof value === "number") return <>{assumed.height(heightInWords(value, person.value.units))}</>;
  // How the outline was taken was the caller's choice: its reason says it all.
  if (quantity === TOLD) return <>{reason}</>;
  return (
    <>
      {assumed.other(fieldName(quantity), String(value))} {reason}
    </>
  );
}
