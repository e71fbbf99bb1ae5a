// What nobody said and had to be assumed.
import type { Remark } from "../api/types";
import { person } from "../draft/draft";
import { heightInWords } from "../draft/person";
import { measured } from "../messages/figures";
import { messages } from "../messages";

interface Props {
  readonly assumptions: readonly Remark[];
  readonly heightM: number;
  /** As on 35 mm film. */
  readonly lensMm: number;
}

export function AssumptionNotes({ assumptions, heightM, lensMm }: Props) {
  const { assumed } = messages.frame;
  const words: Readonly<Record<string, (remark: Remark) => string>> = {
    "lens-assumed": () => assumed.lens(measured(lensMm, "millimeter")),
    "height-assumed": () => assumed.height(heightInWords(heightM, person.value.units)),
    "points-proposed": ({ where }) => assumed.points(where.length),
  };
  return (
    <>
      {assumptions.map((remark) => (
        <p class="note" key={remark.code}>
          {words[remark.code]?.(remark) ?? `${remark.reason} ${remark.remedy}`}
        </p>
      ))}
    </>
  );
}
