// One body from several pictures.
import type { CombinedResult } from "../../api/types";
import { person } from "../../draft/draft";
import { messages } from "../../messages";
import { MeasuresHead } from "../../result/Measures";
import { furtherMeasures, isChief, measureLabel, shown } from "../../result/reading";
import { OtherFits } from "../OtherFits";
import { percent } from "../percent";
import type { Kind } from "./kind";

interface CombinedWishes {
  /** Other fits of the same person, by id. */
  readonly fits: readonly string[];
}

export const FIRST_COMBINED: CombinedWishes = { fits: [] };

export const combined: Kind<CombinedWishes> = {
  request: ({ fits }) => ({ kind: "combined", fits: [...fits] }),
  lacks: ({ fits }) => (fits.length === 0 ? words().lacks : null),
  Options: ({ parent, wishes, onWish }) => <OtherFits fit={parent} chosen={wishes.fits} onChoose={(fits) => onWish({ fits })} />,
  pictures: [{ file: "combined.png", alt: () => words().pictured, label: () => words().beside }],
  pictureOf: (file) => {
    const number = /^overlay_(\d+)\.png$/.exec(file)?.[1];
    return number ? { file, label: () => words().picture(number), alt: () => words().over(number), caption: () => words().caption(number) } : null;
  },
  turns: { file: "body_combined.glb", label: () => words().turned },
  hasTable: true,
  told: (result) =>
    result.kind === "combined" && (
      <>
        <p class="fine">
          {words().told(result.pictures, percent(result.agreement))}
        </p>
        <Measurements of={result.measurements} />
      </>
    ),
};

function words() {
  return messages.derived.combined;
}

function Measurements({ of: measurements }: { of: CombinedResult["measurements"] }) {
  const { units } = person.value;
  const row = (measurement: CombinedResult["measurements"][number]) => {
    const { value, unit, interval } = shown(measurement, units);
    return (
      <tr key={measurement.name}>
        <th scope="row" title={measurement.definition}>
          {measureLabel(measurement.name)}
        </th>
        <td class="number">
          {value} <small>{unit}</small>
        </td>
        <td class="number interval">{interval ?? (measurement.given ? messages.result.given : "–")}</td>
      </tr>
    );
  };
  return (
    <table class="measures">
      <caption class="unseen">{words().measurements}</caption>
      <MeasuresHead />
      <tbody>{measurements.filter((each) => isChief(each.name)).map(row)}</tbody>
      {furtherMeasures(measurements).map((group) => (
        <tbody key={group.heading}>
          <tr class="measures-group">
            <th scope="rowgroup" colSpan={3}>
              {group.heading}
            </th>
          </tr>
          {group.members.map(row)}
        </tbody>
      ))}
    </table>
  );
}
