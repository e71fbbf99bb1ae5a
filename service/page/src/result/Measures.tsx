// The measurements with their intervals.
import type { Measurement } from "../api/types";
import { person } from "../draft/draft";
import { inUnits } from "../draft/person";
import { percent } from "../messages/figures";
import { messages } from "../messages";
import { Choice } from "../ui/Choice";
import { INTERVAL_SHARE, furtherMeasures, isChief, measureLabel, shown } from "./reading";

interface Props {
  readonly measurements: readonly Measurement[];
  /** Whether the body they are of fits its picture. */
  readonly reliable: boolean;
  readonly pointedAt: string | null;
  readonly onPoint: (name: string | null) => void;
  /** Show where a measurement is taken. */
  readonly onShow: (name: string) => void;
}

export function Measures({ measurements, reliable, pointedAt, onPoint, onShow }: Props) {
  const { frame, person: said, result: words } = messages;
  const { units } = person.value;
  const further = furtherMeasures(measurements);
  const look = reliable ? "measures" : "measures is-unreliable";
  const row = (measurement: Measurement) => {
    const { value, unit, interval } = shown(measurement, units);
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
          {interval ?? (measurement.given ? words.given : "–")}
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
      {reliable && <p class="fine">{words.intervals(percent(INTERVAL_SHARE))}</p>}
      <table class={look}>
        <MeasuresHead />
        <tbody>{measurements.filter((each) => isChief(each.name)).map(row)}</tbody>
      </table>
      {further.length > 0 && (
        <details class="more-measures">
          <summary>{words.more(further.reduce((count, group) => count + group.members.length, 0))}</summary>
          <table class={look}>
            <MeasuresHead />
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
      <p class="fine">{words.note}</p>
    </section>
  );
}

/** The id of a measurement's row. */
export function rowOf(name: string): string {
  return `measure-${name}`;
}

function MeasuresHead() {
  const { head } = messages.result;
  return (
    <thead>
      <tr>
        <th scope="col">{head.measure}</th>
        <th scope="col" class="number">
          {head.value}
        </th>
        <th scope="col" class="number">
          {head.interval(percent(INTERVAL_SHARE))}
        </th>
      </tr>
    </thead>
  );
}
