// The size of a chart that the person takes.
import type { SizeResult } from "../../api/types";
import { messages } from "../../messages";
import { FileButton } from "../../ui/FileButton";
import { percent } from "../percent";
import type { Kind, OptionProps } from "./kind";

interface SizeWishes {
  /** As CSV: a column of sizes, and one for each measurement in cm. */
  readonly chart: string;
}

const words = messages.products.size;
const EXAMPLE = "size,chest_girth,waist_girth_navel,hip_girth\nS,84-88,68-72,90-94\nM,92-96,76-80,98-102\nL,100-104,84-88,106-110";

export const FIRST_SIZE: SizeWishes = { chart: "" };

export const size: Kind<SizeWishes> = {
  request: ({ chart }) => ({ kind: "size", chart_csv: chart }),
  lacks: ({ chart }) => (chart.trim() === "" ? words.lacks : null),
  Options: ChartField,
  told: (result) => result.kind === "size" && <Sizes result={result} />,
};

function ChartField({ wishes: { chart }, onWish }: OptionProps<SizeWishes>) {
  return (
    <>
      <label class="field">
        {words.chart}
        <textarea rows={5} spellcheck={false} placeholder={EXAMPLE} value={chart} onInput={(event) => onWish({ chart: event.currentTarget.value })} />
      </label>
      <div class="row">
        <FileButton accept=".csv,text/csv" onChoose={async ([file]) => onWish({ chart: await file!.text() })}>
          {words.choose}
        </FileButton>
        <button class="button is-small" type="button" onClick={() => onWish({ chart: EXAMPLE })}>
          {words.useExample}
        </button>
      </div>
    </>
  );
}

function Sizes({ result: { recommended, none_fits: none, sizes } }: { result: SizeResult }) {
  return (
    <>
      <p class="quality">{recommended === null ? words.none : words.found(recommended)}</p>
      <dl class="facts">
        {sizes.map(({ label, probability }) => (
          <>
            <dt>{label}</dt>
            <dd>{percent(probability)}</dd>
          </>
        ))}
        <dt>{words.noneFits}</dt>
        <dd>{percent(none)}</dd>
      </dl>
    </>
  );
}
