// What nobody said and had to be assumed.
import type { Assumption } from "../api/types";
import { person } from "../draft/draft";
import { heightInWords } from "../draft/person";
import { measured } from "../messages/figures";
import { messages } from "../messages";
import { fieldName } from "./answered";

export function AssumptionNotes({ assumptions }: { assumptions: readonly Assumption[] }) {
  return (
    <>
      {assumptions.map((assumption) => (
        <p class="note" key={assumption.quantity}>
          {inWords(assumption)}
        </p>
      ))}
    </>
  );
}

function inWords({ quantity, value, reason }: Assumption): string {
  const { assumed } = messages.frame;
  if (quantity === "focal_length_35mm" && typeof value === "number") return assumed.lens(measured(value, "millimeter"));
  if (quantity === "height_m" && typeof value === "number") return assumed.height(heightInWords(value, person.value.units));
  // Their names tell nobody anything.
  if (quantity === "points" && typeof value === "string") return assumed.points(value.split(", ").length);
  // How the outline was taken was the caller's choice: its reason says it all.
  return quantity === "outline" ? reason : `${assumed.other(fieldName(quantity), String(value))} ${reason}`;
}
