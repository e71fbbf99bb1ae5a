// The measurements with their intervals, and what shading changed in them.
import { useState } from "preact/hooks";
import type { Measurement } from "../api/types";
import { person } from "../draft/draft";
import { inUnits } from "../draft/person";
import { Choice } from "../ui/Choice";
import { difference, furtherMeasures, isChief, measureLabel, shown } from "./reading";

interface Props {
  readonly measurements: readonly Measurement[];
  /** The same by silhouette and edges alone, where they can be compared. */
  readonly before: readonly Measurement[] | null;
  readonly pointedAt: string | null;
  readonly onPoint: (name: string | null) => void;
  /** Show where a measurement is taken. */
  readonly onShow: (name: string) => void;
}

export function Measures({ measurements, before, pointedAt, onPoint, onShow }: Props) {
  const [compared, setCompared] = useState(false);
  const { units } = person.value;
  const further = furtherMeasures(measurements);
  const row = (measurement: Measurement) => {
    const { value, unit, interval } = shown(measurement, units);
    const other = compared ? before?.find((each) => each.name === measurement.name) : undefined;
    return (
      <tr
        key={measurement.name}
        class={pointedAt === measurement.name ? "is-pointed" : ""}
        onPointerEnter={() => onPoint(measurement.name)}
        onPointerLeave={() => onPoint(null)}
      >
        <th scope="row">
          <button
            type="button"
            class="measure-name"
            title={measurement.definition}
            onClick={() => onShow(measurement.name)}
            onFocus={() => onPoint(measurement.name)}
            onBlur={() => onPoint(null)}
          >
            {measureLabel(measurement.name)}
          </button>
        </th>
        <td class="number">
          {value} <small>{unit}</small>
        </td>
        <td class="number interval">
          {other
            ? `${shown(other, units).value} (${difference(measurement, other, units)})`
            : (interval ?? (measurement.given ? "given" : "–"))}
        </td>
      </tr>
    );
  };
  return (
    <section class="section" aria-labelledby="measures-title">
      <header class="section-head">
        <h2 id="measures-title">Measurements</h2>
        <Choice
          name="result-units"
          legend="Units"
          quiet
          options={[
            { value: "metric", label: "cm, kg" },
            { value: "imperial", label: "in, lb" },
          ]}
          value={units}
          onChange={(value) => (person.value = inUnits(person.value, value))}
        />
      </header>
      <table class="measures">
        <MeasuresHead compared={compared} />
        <tbody>{measurements.filter((each) => isChief(each.name)).map(row)}</tbody>
      </table>
      {further.length > 0 && (
        <details class="more-measures">
          <summary>{further.reduce((count, group) => count + group.members.length, 0)} more measurements</summary>
          <table class="measures">
            <MeasuresHead compared={compared} />
            {further.map((group) => (
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
        </details>
      )}
      {before && (
        <label class="check">
          <input type="checkbox" checked={compared} onChange={(event) => setCompared(event.currentTarget.checked)} />
          Compare with the fit by outline alone (SE), and what shading changed (SES)
        </label>
      )}
      <p class="fine">
        In the upright pose, right limbs; choose one to see where it is taken. Intervals are the fit's own and somewhat narrow: about nine of ten hold the
        truth. This is no medical device.
      </p>
    </section>
  );
}

function MeasuresHead({ compared }: { readonly compared: boolean }) {
  return (
    <thead>
      <tr>
        <th scope="col">Measure</th>
        <th scope="col" class="number">
          Value
        </th>
        <th scope="col" class="number">
          {compared ? "By outline alone" : "95 % interval"}
        </th>
      </tr>
    </thead>
  );
}
