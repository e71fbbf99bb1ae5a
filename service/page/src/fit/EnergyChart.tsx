// Total energy over a fit's progress, on a logarithmic scale, and its terms now.
import { decimal } from "../messages/figures";
import { messages } from "../messages";
import { termLabel } from "./stages";
import type { Reading } from "./watch";

const WIDTH = 320;
const HEIGHT = 120;
const PAD = 6;

export function EnergyChart({ readings }: { readings: readonly Reading[] }) {
  const { misfit } = messages.fit;
  const last = readings.at(-1);
  if (!last) return <p class="fine chart-empty">{misfit.empty}</p>;
  const logs = readings.map((reading) => Math.log(Math.max(reading.total, 1e-3)));
  const [low, high] = [Math.min(...logs), Math.max(...logs)];
  const x = (progress: number) => PAD + progress * (WIDTH - 2 * PAD);
  const y = (log: number) => HEIGHT - PAD - ((log - low) / Math.max(high - low, 1e-6)) * (HEIGHT - 2 * PAD);
  const pieces = byStage(readings).map((piece) =>
    piece.map((reading) => `${x(reading.progress).toFixed(1)},${y(Math.log(Math.max(reading.total, 1e-3))).toFixed(1)}`),
  );
  const largest = Math.max(...Object.values(last.energies));
  return (
    <>
      <svg class="chart" viewBox={`0 0 ${WIDTH} ${HEIGHT}`} role="img" aria-label={misfit.now(decimal(last.total))}>
        {pieces.map((piece, i) => (
          <polyline key={i} points={piece.join(" ")} />
        ))}
        <circle cx={x(last.progress)} cy={y(logs.at(-1)!)} r="3.5" />
      </svg>
      <dl class="terms">
        <dt>{misfit.total}</dt>
        <dd>{decimal(last.total, 1)}</dd>
        {Object.entries(last.energies).map(([name, value]) => (
          <>
            <dt>{termLabel(name)}</dt>
            <dd>
              <i class="term-bar" aria-hidden="true">
                <i style={{ width: `${(100 * value) / Math.max(largest, 1e-9)}%` }} />
              </i>
              {decimal(value, 1)}
            </dd>
          </>
        ))}
      </dl>
    </>
  );
}

/** The energy of one stage is not that of the next: other terms count. */
function byStage(readings: readonly Reading[]): Reading[][] {
  const pieces: Reading[][] = [];
  for (const reading of readings) {
    const piece = pieces.at(-1);
    if (piece && piece[0]!.stage === reading.stage) piece.push(reading);
    else pieces.push([reading]);
  }
  return pieces;
}
