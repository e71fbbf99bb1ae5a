// Where times and values lie on a chart.
export interface Scale {
  readonly low: number;
  readonly high: number;
  readonly ticks: readonly number[];
}

const STEPS = [1, 2, 5, 10];
const MOST_TICKS = 4;

/** Round ends that hold all values, and what is written between them. */
export function scaleOf(values: readonly number[]): Scale {
  const [least, most] = [Math.min(...values), Math.max(...values)];
  const step = stepOf(Math.max(most - least, 1));
  const low = Math.floor(least / step) * step;
  const high = Math.max(Math.ceil(most / step) * step, low + step);
  const count = Math.round((high - low) / step);
  return { low, high, ticks: Array.from({ length: count + 1 }, (_, place) => low + place * step) };
}

function stepOf(span: number): number {
  const power = 10 ** Math.floor(Math.log10(span / MOST_TICKS));
  return power * (STEPS.find((step) => span / (step * power) <= MOST_TICKS) ?? 10);
}

/** From 0 at the first to 1 at the last; in the middle where all are one. */
export function shareOf(value: number, first: number, last: number): number {
  return last > first ? (value - first) / (last - first) : 0.5;
}
