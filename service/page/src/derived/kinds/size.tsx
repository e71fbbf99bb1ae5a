// The size of a chart that the person takes.
import type { SizeResult } from "../../api/types";
import { decimal, either, measured, typed } from "../../messages/figures";
import { messages } from "../../messages";
import { measureLabel } from "../../result/reading";
import { EMPTY_CHART, chartCsv } from "../chart";
import type { TypedChart } from "../chart";
import { percent } from "../percent";
import { SizeChart } from "../SizeChart";
import type { Kind } from "./kind";

interface SizeWishes {
  readonly chart: TypedChart;
  /** The chart as a file: it goes before the one that was typed. */
  readonly chartFile: File | null;
}

type Argument = SizeResult["arguments"][number];

const words = () => messages.derived.size;

export const FIRST_SIZE: SizeWishes = { chart: EMPTY_CHART, chartFile: null };

export const size: Kind<SizeWishes> = {
  request: ({ chart, chartFile }) => {
    const typed = chartFile ? null : chartCsv(chart);
    return { kind: "size", ...(typed === null ? {} : { chart_csv: typed }) };
  },
  part: ({ chartFile }) => (chartFile ? { name: "chart", file: chartFile } : null),
  lacks: ({ chart, chartFile }) => (chartFile || chartCsv(chart) !== null ? null : words().lacks),
  Options: ({ wishes: { chart, chartFile }, onWish }) => (
    <SizeChart chart={chart} file={chartFile} onType={(chart) => onWish({ chart })} onChoose={(chartFile) => onWish({ chartFile })} />
  ),
  pictures: [],
  told: (result) => result.kind === "size" && <Sizes result={result} />,
};

function Sizes({ result: { recommended, none_fits: none, sizes, compared_with: compared, arguments: reasons } }: { result: SizeResult }) {
  const { none: noSize, found, noneFits } = words();
  return (
    <>
      <p class="quality">{recommended === null ? noSize : found(recommended)}</p>
      <dl class="facts">
        {sizes.map(({ label, probability }) => (
          <>
            <dt>{label}</dt>
            <dd>{percent(probability)}</dd>
          </>
        ))}
        <dt>{noneFits}</dt>
        <dd>{percent(none)}</dd>
      </dl>
      <ul class="reasons fine">
        {reasons.map((reason) => (
          <li key={reason.name}>{reasonText(reason, compared)}</li>
        ))}
      </ul>
    </>
  );
}

/** In the chart's units, which are the measurement's own. */
function reasonText({ name, unit, value, standard_error: error, ease, low, high, off, sized_as: as, sizes }: Argument, size: string): string {
  const { compared, range, reason, value: valueText, withEase } = words();
  const inUnit = (amount: number) => measured(amount, unit === "kg" ? "kilogram" : "centimeter", 1);
  const found = valueText(decimal(value + ease, 1), inUnit(error));
  const from = low === null || high === null ? "" : range(typed(low, 1), typed(high, 1));
  return reason(measureLabel(name), ease === 0 ? found : withEase(found, inUnit(ease)), compared[as](size, from, inUnit(off)), either(sizes));
}
