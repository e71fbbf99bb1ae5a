// A measurement over time: its values, and bars for their intervals.
import { person } from "../draft/draft";
import { day, decimal } from "../messages/figures";
import { messages } from "../messages/language";
import { WITHIN_95, inUnit, measureLabel, shown } from "../result/reading";
import type { Compared } from "./chosen";
import type { PersonRecord } from "./records";
import { scaleOf, shareOf } from "./scale";

const WIDTH = 340;
const HEIGHT = 170;
const LEFT = 38;
const RIGHT = 14;
const TOP = 10;
const BOTTOM = 26;
const DOT = 4;

/** `records` newest first; those without this measurement are left out. */
export function TimeChart({ name, records }: { name: Compared; records: readonly PersonRecord[] }) {
  const { people: words, result } = messages.value;
  const { units } = person.value;
  const rows = [...records].reverse().flatMap(({ fit, measurements }) => {
    const measurement = measurements.find((each) => each.name === name);
    return measurement ? [{ fit, measurement }] : [];
  });
  if (rows.length === 0) return null;
  const { factor, unit } = inUnit(rows[0]!.measurement.unit, units);
  const points = rows.map(({ fit, measurement: { value, standard_error } }) => {
    const half = WITHIN_95 * (standard_error ?? 0);
    return { fit, at: Date.parse(fit.created_at), value: factor * value, low: factor * (value - half), high: factor * (value + half) };
  });
  const scale = scaleOf(points.flatMap(({ low, high }) => [low, high]));
  const [first, last] = [points[0]!.at, points.at(-1)!.at];
  const x = (at: number) => LEFT + DOT + shareOf(at, first, last) * (WIDTH - LEFT - RIGHT - 2 * DOT);
  const y = (value: number) => HEIGHT - BOTTOM - shareOf(value, scale.low, scale.high) * (HEIGHT - TOP - BOTTOM);
  const digits = scale.ticks.every(Number.isInteger) ? 0 : 1;
  return (
    <figure class="time-chart" data-measure={name}>
      <figcaption>
        {measureLabel(name)} <small>{unit}</small>
      </figcaption>
      <svg viewBox={`0 0 ${WIDTH} ${HEIGHT}`} aria-hidden="true">
        {scale.ticks.map((tick) => (
          <g key={tick}>
            <path class="time-grid" d={`M${LEFT} ${y(tick)}H${WIDTH - RIGHT}`} />
            <text x={LEFT - 6} y={y(tick)} dy="4" text-anchor="end">
              {decimal(tick, digits)}
            </text>
          </g>
        ))}
        <text x={first === last ? x(first) : LEFT} y={HEIGHT - 6} text-anchor={first === last ? "middle" : "start"}>
          {day(rows[0]!.fit.created_at)}
        </text>
        {first !== last && (
          <text x={WIDTH - RIGHT} y={HEIGHT - 6} text-anchor="end">
            {day(rows.at(-1)!.fit.created_at)}
          </text>
        )}
        <polyline class="time-line" points={points.map((point) => `${x(point.at)},${y(point.value)}`).join(" ")} />
        {points.map((point) => (
          <g key={point.fit.id} class="time-point">
            <path d={`M${x(point.at)} ${y(point.low)}V${y(point.high)}`} />
            {point.fit.kind === "fit" ? (
              <circle cx={x(point.at)} cy={y(point.value)} r={DOT} />
            ) : (
              <rect x={x(point.at) - DOT} y={y(point.value) - DOT} width={2 * DOT} height={2 * DOT} />
            )}
          </g>
        ))}
      </svg>
      <table class="unseen">
        <caption>{words.tableOf(measureLabel(name))}</caption>
        <thead>
          <tr>
            <th scope="col">{words.day}</th>
            <th scope="col">{words.what}</th>
            <th scope="col">{result.head.value}</th>
            <th scope="col">{words.interval}</th>
          </tr>
        </thead>
        <tbody>
          {rows.map(({ fit, measurement }) => {
            const { value, interval } = shown(measurement, units);
            return (
              <tr key={fit.id}>
                <th scope="row">{day(fit.created_at)}</th>
                <td>{words.kinds[fit.kind]}</td>
                <td>
                  {value} {unit}
                </td>
                <td>{interval ?? (measurement.given ? result.given : "–")}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </figure>
  );
}
