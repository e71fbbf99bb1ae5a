// Where the light comes from: a ball to be lit by dragging.
import { useLayoutEffect, useRef } from "preact/hooks";
import type { LightGuess } from "../api/types";
import { cues, light, surroundings } from "../draft/draft";
import { Choice } from "../ui/Choice";
import { drawBall, lightAt } from "./ball";

const SIDE_PX = 96;
const STEP_DEG = 5;

export function LightPanel() {
  const guess = light.value;
  return (
    <div class="subsection">
      <h3>Light</h3>
      <div class="light">
        <Ball guess={guess} />
        <div>
          <p class="fine">
            {guess
              ? `${wordsFor(guess)}. A first guess; the fit refines it.`
              : "Found by the fit. If you see where it comes from, drag the ball until it is lit like the person."}
          </p>
          {guess && (
            <>
              <Choice
                name="light-kind"
                legend="Kind of light"
                quiet
                options={[
                  { value: "point", label: "Lamp" },
                  { value: "directional", label: "Sun" },
                ]}
                value={guess.kind ?? "point"}
                onChange={(kind) => (light.value = { ...guess, kind })}
              />
              <button class="link" type="button" onClick={() => (light.value = null)}>
                Leave it to the fit
              </button>
            </>
          )}
        </div>
      </div>
      {cues.value === "SES" && (
        <>
          <Choice
            name="surroundings"
            legend="Light of the surroundings"
            options={[
              { value: "uniform", label: "Even", title: "Eq. 1 of the paper" },
              { value: "spherical_harmonics", label: "By direction", title: "Second-order spherical harmonics" },
            ]}
            value={surroundings.value}
            onChange={(kind) => (surroundings.value = kind)}
          />
          <p class="fine">
            {surroundings.value === "uniform"
              ? "One lamp or the sun, and the same faint light from everywhere."
              : "For the sky, windows, bright walls: light from around may differ by direction."}
          </p>
        </>
      )}
    </div>
  );
}

function Ball({ guess }: { guess: LightGuess | null }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  // Before it is shown: what it says and what is seen are never of two lights.
  useLayoutEffect(() => drawBall(canvas.current!, guess), [guess]);
  const set = (azimuth: number, elevation: number) => {
    const azimuth_deg = Math.round(Math.max(-90, Math.min(90, azimuth)));
    const elevation_deg = Math.round(Math.max(-90, Math.min(90, elevation)));
    light.value = { kind: guess?.kind ?? "point", azimuth_deg, elevation_deg };
  };
  const drag = (event: PointerEvent) => {
    const box = canvas.current!.getBoundingClientRect();
    const at = lightAt(
      (2 * (event.clientX - box.left)) / box.width - 1,
      (2 * (event.clientY - box.top)) / box.height - 1,
    );
    set(at.azimuth_deg, at.elevation_deg);
  };
  return (
    <canvas
      ref={canvas}
      class="ball"
      width={2 * SIDE_PX}
      height={2 * SIDE_PX}
      tabIndex={0}
      role="slider"
      aria-label="Direction of the light; arrow keys turn it"
      aria-valuemin={-90}
      aria-valuemax={90}
      aria-valuenow={guess?.azimuth_deg ?? 0}
      aria-valuetext={guess ? wordsFor(guess) : "left to the fit"}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        drag(event);
      }}
      onPointerMove={(event) => {
        if (event.currentTarget.hasPointerCapture(event.pointerId)) drag(event);
      }}
      onKeyDown={(event) => {
        const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
        if (!turn) return;
        event.preventDefault();
        set((guess?.azimuth_deg ?? 0) + STEP_DEG * turn[0]!, (guess?.elevation_deg ?? 0) + STEP_DEG * turn[1]!);
      }}
    />
  );
}

function wordsFor({ azimuth_deg, elevation_deg }: LightGuess): string {
  const [azimuth, elevation] = [azimuth_deg ?? 0, elevation_deg ?? 0];
  const across = Math.abs(azimuth) < 3 ? "straight on" : `${Math.abs(azimuth).toFixed(0)}° from the ${azimuth > 0 ? "right" : "left"}`;
  const along = Math.abs(elevation) < 3 ? "" : `, ${Math.abs(elevation).toFixed(0)}° from ${elevation > 0 ? "above" : "below"}`;
  return across + along;
}
