// The measurements with their intervals, and what shading changed in them.
import { useState } from "preact/hooks";
import type { Measurement, StageMeasurement } from "../api/types";
import { person } from "../draft/draft";
import { inUnits } from "../draft/person";
import { percent } from "../messages/figures";
import { messages } from "../messages";
import { Choice } from "../ui/Choice";
import { INTERVAL_SHARE, difference, furtherMeasures, isChief, measureLabel, shown } from "./reading";

interface Props {
  readonly measurements: readonly Measurement[];
  /** The same by silhouette and edges alone, where they can be compared. */
  readonly before: readonly StageMeasurement[] | null;
  /** Whether the body they are of fits its picture. */
  readonly reliable?: boolean;
  readonly pointedAt: string | null;
  readonly onPoint: (name: string | null) => void;
  /** Show where a measurement is taken. */
  readonly onShow: (name: string) => void;
}

export function Measures({ measurements, before, reliable = true, pointedAt, onPoint, onShow }: Props) {
  const { frame, person: said, result: words } = messages;
  const [compared, setCompared] = useState(false);
  const { units } = person.value;
  const further = furtherMeasures(measurements);
  const look = reliable ? "measures" : "measures is-unreliable";
  const row = (measurement: Measurement) => {
    const { value, unit, interval } = shown(measurement, units);
    const other = compared ? before?.find((each) => each.name === measurement.name) : undefined;
    return (
      <tr
        key={measurement.name}
        id={rowOf(measurement.name)}
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
            : (interval ?? (measurement.given ? words.given : "–"))}
        </td>
      </tr>
    );
  };
  return (
    <section class="section" aria-labelledby="measures-title">
      <header class="section-head">
        <h2 id="measures-title">{words.allMeasurements}</h2>
        <Choice
          name="result-units"
          legend={frame.units}
          quiet
          options={[
            { value: "metric", label: said.metric },
            { value: "imperial", label: words.imperial },
          ]}
          value={units}
          onChange={(value) => (person.value = inUnits(person.value, value))}
        />
      </header>
      {!reliable && <p class="note is-problem">{words.unreliable}</p>}
      {reliable && !compared && <p class="fine">{words.intervals(percent(INTERVAL_SHARE))}</p>}
      <table class={look}>
        <MeasuresHead compared={compared} />
        <tbody>{measurements.filter((each) => isChief(each.name)).map(row)}</tbody>
      </table>
      {further.length > 0 && (
        <details class="more-measures">
          <summary>{words.more(further.reduce((count, group) => count + group.members.length, 0))}</summary>
          <table class={look}>
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
          {words.compare}
        </label>
      )}
      <p class="fine">{words.note}</p>
    </section>
  );
}

/** The id of a measurement's row. */
export function rowOf(name: string): string {
  return `measure-${name}`;
}

export function MeasuresHead({ compared = false }: { readonly compared?: boolean }) {
  const { head } = messages.result;
  return (
    <thead>
      <tr>
        <th scope="col">{head.measure}</th>
        <th scope="col" class="number">
          {head.value}
        </th>
        <th scope="col" class="number">
          {compared ? head.outline : head.interval(percent(INTERVAL_SHARE))}
        </th>
      </tr>
    </thead>
  );
}
