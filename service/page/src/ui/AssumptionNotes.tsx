// What nobody said and had to be assumed.
import type { InitialPose } from "../api/types";

export type Assumptions = InitialPose["assumptions"];

export function AssumptionNotes({ assumptions }: { assumptions: Assumptions }) {
  return (
    <>
      {assumptions.map(({ quantity, value, reason }) => (
        <p class="note" key={quantity}>
          Assumed: {quantity.replaceAll("_", " ")} {typeof value === "number" ? Number(value.toPrecision(4)) : value}.{" "}
          {reason}
        </p>
      ))}
    </>
  );
}
