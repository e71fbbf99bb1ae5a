// The share of fat, by formulas from the literature.
import type { CompositionResult } from "../../api/types";
import { decimal } from "../../messages/figures";
import { messages } from "../../messages";
import { plainName, wordFor } from "../../messages/words";
import type { Kind } from "./kind";

const words = messages.products.composition;

export const composition: Kind = {
  request: () => ({ kind: "composition" }),
  told: (result) => result.kind === "composition" && <Estimates result={result} />,
};

function Estimates({ result: { bmi, estimates } }: { result: CompositionResult }) {
  return (
    <dl class="facts">
      <dt>{words.bmi}</dt>
      <dd>{decimal(bmi, 1)}</dd>
      {estimates.map(({ name, source, percent, standard_error: error, withheld }) => (
        <>
          <dt title={source}>{wordFor(words.formulas, name) ?? plainName(name)}</dt>
          <dd>{percent === null ? withheld.join(" ") : words.fat(decimal(percent, 1), error === null ? null : decimal(error, 1))}</dd>
        </>
      ))}
    </dl>
  );
}
