// What nobody said and had to be assumed.
import type { InitialPose } from "../api/types";

export type Assumptions = InitialPose["assumptions"];

const WORDS: Readonly<Record<string, (value: number) => string>> = {
  focal_length_35mm: (value) => `A lens of ${value.toFixed(0)} mm (as on 35 mm film)`,
  height_m: (value) => `A height of ${(100 * value).toFixed(0)} cm`,
};

/** How the outline was taken was the caller's choice: its reason says it all. */
const TOLD = "outline";

export function AssumptionNotes({ assumptions }: { assumptions: Assumptions }) {
  return (
    <>
      {assumptions.map(({ quantity, value, reason }) => (
        <p class="note" key={quantity}>
          {quantity !== TOLD && `${inWords(quantity, value)} is assumed. `}
          {reason}
        </p>
      ))}
    </>
  );
}

function inWords(quantity: string, value: Assumptions[number]["value"]): string {
  const said = WORDS[quantity];
  if (said && typeof value === "number") return said(value);
  return `${quantity.replaceAll("_", " ")} ${value}`;
}
