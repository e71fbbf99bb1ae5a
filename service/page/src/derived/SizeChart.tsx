// A size chart, to be typed or chosen as a file.
import { TAPE_NAMES } from "../draft/person";
import type { TapeName } from "../draft/person";
import { messages } from "../messages";
import { measureLabel } from "../result/reading";
import { FileChoice } from "./FileChoice";
import type { TypedChart, TypedSize } from "./chart";

interface Props {
  readonly chart: TypedChart;
  readonly file: File | null;
  readonly onType: (chart: TypedChart) => void;
  readonly onChoose: (file: File | null) => void;
}

export function SizeChart({ chart, file, onType, onChoose }: Props) {
  const { size: words } = messages.derived;
  const choice = <FileChoice label={file ? words.another : words.choose} accept=".csv,.tsv,.txt,text/csv" onChoose={onChoose} />;
  if (file) {
    return (
      <div class="row">
        {choice}
        <button class="button is-small" type="button" onClick={() => onChoose(null)}>
          {words.type}
        </button>
        <span class="fine">{words.isChart(file.name)}</span>
      </div>
    );
  }
  return (
    <>
      <ChartTable chart={chart} onType={onType} />
      <div class="row">
        <button
          class="button is-small"
          type="button"
          onClick={() => onType({ ...chart, sizes: [...chart.sizes, { label: "", cells: chart.columns.map(() => "") }] })}
        >
          {words.add}
        </button>
        {choice}
      </div>
    </>
  );
}

function ChartTable({ chart, onType }: Pick<Props, "chart" | "onType">) {
  const { columns, sizes } = chart;
  const { size: words } = messages.derived;
  const change = (row: number, changed: Partial<TypedSize>) =>
    onType({ ...chart, sizes: sizes.map((each, number) => (number === row ? { ...each, ...changed } : each)) });
  const rename = (column: number, name: TapeName) =>
    onType({ ...chart, columns: columns.map((each, number) => (number === column ? name : each)) });
  return (
    <table class="size-chart">
      <caption class="fine">
        {words.caption}. {words.inCm}
      </caption>
      <thead>
        <tr>
          <th scope="col">{words.size}</th>
          {columns.map((name, column) => (
            <th scope="col" key={name}>
              <span aria-hidden="true">{words.broken(measureLabel(name))}</span>
              <select aria-label={words.column(column + 1)} value={name} onChange={(event) => rename(column, event.currentTarget.value as TapeName)}>
                {TAPE_NAMES.filter((each) => each === name || !columns.includes(each)).map((each) => (
                  <option key={each} value={each}>
                    {measureLabel(each)}
                  </option>
                ))}
              </select>
            </th>
          ))}
        </tr>
      </thead>
      <tbody>
        {sizes.map(({ label, cells }, row) => (
          <tr key={row}>
            <td>
              <input aria-label={words.labelOf(row + 1)} value={label} onInput={(event) => change(row, { label: event.currentTarget.value })} />
            </td>
            {columns.map((name, column) => (
              <td key={name}>
                <input
                  aria-label={`${label || words.row(row + 1)}: ${measureLabel(name)}`}
                  autocomplete="off"
                  value={cells[column] ?? ""}
                  onInput={({ currentTarget: { value } }) => change(row, { cells: cells.map((each, number) => (number === column ? value : each)) })}
                />
              </td>
            ))}
          </tr>
        ))}
      </tbody>
    </table>
  );
}
