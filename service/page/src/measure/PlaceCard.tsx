// One of the two pictures: how to stand, the picture once there is one, and what the service says of it.
import { useSignal } from "@preact/signals";
import { Icon } from "../ui/Icon";
import { ProblemNote } from "../ui/ProblemNote";
import { canPropose } from "../draft/proposing";
import { Camera } from "./Camera";
import { Findings } from "./Findings";
import { hasCamera } from "./lens";
import { askForLevel } from "./level";
import { putPicture } from "./places";
import type { Place, PlaceName } from "./places";
import { Silhouette } from "./Silhouette";

const WORDS: Readonly<Record<PlaceName, { title: string; stance: string }>> = {
  front: { title: "Front", stance: "Face the camera. Feet apart as wide as the shoulders, arms well away from the body." },
  side: { title: "Side", stance: "Turn to either side. Feet together, arms stretched forward, looking ahead." },
};

export function PlaceCard({ place }: { place: Place }) {
  const films = useSignal(false);
  const fault = useSignal<string | null>(null);
  const { name } = place;
  const picture = place.picture.value;
  const take = async (file: Blob, title: string) => {
    films.value = false;
    fault.value = null;
    try {
      await putPicture(place, file, title);
    } catch (error) {
      fault.value = error instanceof Error ? error.message : String(error);
    }
  };
  return (
    <section class="place" aria-labelledby={`place-${name}`} data-place={name}>
      <h2 id={`place-${name}`}>{WORDS[name].title}</h2>
      <div class="place-picture">{picture ? <img src={picture.url} alt={`The ${name} picture`} /> : <Silhouette view={name} />}</div>
      <div class="place-words">
        {!picture && <p>{WORDS[name].stance}</p>}
        {fault.value && (
          <p class="note is-problem" role="alert">
            {fault.value}
          </p>
        )}
        <Said place={place} />
        <div class="row">
          {hasCamera() ? (
            <button
              class="button"
              type="button"
              onClick={() => {
                void askForLevel();
                films.value = true;
              }}
            >
              {picture ? "Take again" : "Take a picture"}
            </button>
          ) : (
            <FileButton label={picture ? "Take again" : "Take a picture"} named={`Take the ${name} picture`} camera onChoose={take} />
          )}
          <FileButton label={picture ? "Other file" : "Choose a file"} named={`Choose a file: ${name}`} onChoose={take} />
        </div>
      </div>
      {films.value && <Camera view={name} onTaken={(photo) => void take(photo, name)} onClose={() => (films.value = false)} />}
    </section>
  );
}

interface FileProps {
  readonly label: string;
  readonly named: string;
  /** Whether the phone's camera is opened, not its gallery. */
  readonly camera?: boolean;
  readonly onChoose: (file: File, name: string) => void;
}

function FileButton({ label, named, camera, onChoose }: FileProps) {
  return (
    <label class="button">
      {label}
      <input
        class="unseen"
        type="file"
        accept="image/*"
        aria-label={named}
        {...(camera ? { capture: "environment" } : {})}
        onChange={(event) => {
          const file = event.currentTarget.files?.[0];
          event.currentTarget.value = "";
          if (file) onChoose(file, file.name);
        }}
      />
    </label>
  );
}

/** What is known of the picture so far. */
function Said({ place }: { place: Place }) {
  const { picture, problem, check, isChecking } = place;
  if (!picture.value) return null;
  if (problem.value) return <ProblemNote problem={problem.value} />;
  if (!canPropose.value) return null;
  if (!check.value) return <p class="fine">Looking at the picture …</p>;
  if (check.value.findings.length > 0) return <Findings findings={check.value.findings} />;
  return (
    <p class="place-good" aria-busy={isChecking.value}>
      <Icon name="check" /> Good to measure
    </p>
  );
}
