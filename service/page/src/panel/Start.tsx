// Before there is a picture: drop, paste, choose or take one, or try the sample.
import { useSignal } from "@preact/signals";
import { canPropose } from "../draft/proposing";
import { MEASURE_ADDRESS } from "../route";
import { Choice } from "../ui/Choice";
import { Icon } from "../ui/Icon";
import { openFile, openProblem, trySample } from "./open";
import type { Beginning } from "./open";

const SAMPLES: readonly { name: string; label: string; alt: string; width: number; height: number }[] = [
  { name: "sample", label: "At ease", alt: "A man stands at ease, a hand on his hip, lit from the left", width: 720, height: 960 },
  { name: "woman", label: "Upright", alt: "A woman stands upright, arms and legs apart", width: 480, height: 640 },
  { name: "arm_across", label: "An arm across", alt: "A heavy man holds an arm before his belly", width: 480, height: 640 },
];

export function Start() {
  const over = useSignal(false);
  return (
    <main class="start">
      <div
        class={`drop ${over.value ? "is-over" : ""}`}
        onDragOver={(event) => {
          event.preventDefault();
          over.value = true;
        }}
        onDragLeave={() => (over.value = false)}
        onDrop={(event) => {
          event.preventDefault();
          over.value = false;
          const file = event.dataTransfer?.files[0];
          if (file) void openFile(file);
        }}
      >
        <div class="drop-text">
          <h1>A body from one picture</h1>
          <p class="lead">
            Show the joints of a person in a photograph or painting, or have them proposed. You get the posed body in 3D,
            its measurements, and the light it stands in.
          </p>
          <div class="row">
            <label class="button is-primary">
              <Icon name="picture" />
              Choose a picture
              <input
                class="unseen"
                type="file"
                accept="image/*"
                onChange={(event) => {
                  const file = event.currentTarget.files?.[0];
                  event.currentTarget.value = "";
                  if (file) void openFile(file);
                }}
              />
            </label>
          </div>
          <p class="start-other">
            <a class="button" href={MEASURE_ADDRESS}>
              Measure a person from front and side
            </a>
          </p>
          <p class="fine">You can also drop a picture here, or paste one. On a phone the camera is offered.</p>
          {openProblem.value && (
            <p class="note is-problem" role="alert">
              {openProblem.value}
            </p>
          )}
        </div>
        <Samples />
      </div>
      <ol class="start-steps">
        <li>
          <b>Check</b> the joints that are proposed, or click six of them or more. The body follows.
        </li>
        <li>
          <b>Say</b> what you know: height, weight, lens, light. Unknown is allowed.
        </li>
        <li>
          <b>Look</b> at the body over the picture, from every side, and at what it measures.
        </li>
      </ol>
    </main>
  );
}

function Samples() {
  const beginning = useSignal<Beginning>("placed");
  return (
    <section class="samples" aria-labelledby="samples-title">
      <h2 id="samples-title">No picture at hand? Try one of these</h2>
      <ul>
        {SAMPLES.map(({ name, label, alt, width, height }) => (
          <li key={name}>
            <button type="button" onClick={() => void trySample(name, beginning.value)}>
              <img src={`/page/${name}.jpg`} alt={alt} width={width} height={height} />
              <span>{label}</span>
            </button>
          </li>
        ))}
      </ul>
      <Choice
        name="sample-points"
        legend="Points of the sample"
        quiet
        options={[
          { value: "placed", label: "With points placed" },
          ...(canPropose.value ? [{ value: "proposed" as const, label: "Points proposed" }] : []),
          { value: "open", label: "I click them" },
        ]}
        value={beginning.value}
        onChange={(value) => (beginning.value = value)}
      />
    </section>
  );
}
