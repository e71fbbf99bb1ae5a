// One body from several pictures.
import type { CombinedResult } from "../../api/types";
import { person } from "../../draft/draft";
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
  label: "Combined body",
  help: "One body from several pictures of the same person: narrower intervals than any picture alone gives.",
  request: ({ fits }) => ({ kind: "combined", fits: [...fits] }),
  lacks: ({ fits }) => (fits.length === 0 ? "Choose at least one other fit of this person." : null),
  Options: ({ fit, wishes, onWish }) => <OtherFits fit={fit} chosen={wishes.fits} onChoose={(fits) => onWish({ fits })} />,
  pictures: [{ file: "combined.png", alt: "Combined body beside this fit alone" }],
  pictureOf: (file) => {
    const number = /^overlay_(\d+)\.png$/.exec(file)?.[1];
    return number ? { file, alt: `Combined body over picture ${number}`, caption: `In picture ${number}, as posed there` } : null;
  },
  turns: { file: "body_combined.glb", label: "The combined body" },
  hasTable: true,
  told: (result) =>
    result.kind === "combined" && (
      <>
        <p class="fine">
          {`From ${result.pictures} pictures. Fits of one person differ by as much as these in ${percent(result.agreement)} of cases.`}
        </p>
        <Measurements of={result.measurements} />
      </>
    ),
};

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
        <td class="number interval">{interval ?? (measurement.given ? "given" : "–")}</td>
      </tr>
    );
  };
  return (
    <table class="measures">
      <caption class="unseen">Measurements of the combined body</caption>
      <thead>
        <tr>
          <th scope="col">Measure</th>
          <th scope="col" class="number">
            Value
          </th>
          <th scope="col" class="number">
            95 % interval
          </th>
        </tr>
      </thead>
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
