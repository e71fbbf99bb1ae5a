// One of the two pictures: how to stand, the picture once there is one, and what the service says of it.
import { useSignal } from "@preact/signals";
import { Icon } from "../ui/Icon";
import { canPropose } from "../draft/proposing";
import { messages } from "../messages";
import { Camera } from "./Camera";
import { Findings } from "./Findings";
import { hasCamera } from "./lens";
import { askForLevel } from "./level";
import { sizeOf } from "../panel/size";
import { PictureFile } from "./PictureFile";
import { PictureProblem } from "./PictureProblem";
import { putPicture } from "./places";
import type { Place } from "./places";
import { beginAnew } from "./sent";
import { Silhouette } from "./Silhouette";
import { pictureOf, viewLabel } from "./views";

export function PlaceCard({ place }: { place: Place }) {
  const { place: words } = messages.measure;
  const films = useSignal(false);
  const fault = useSignal<string | null>(null);
  const { name } = place;
  const picture = place.picture.value;
  const take = async (file: Blob, title: string) => {
    films.value = false;
    fault.value = null;
    try {
      await putPicture(place, file, title);
      beginAnew(name);
    } catch (error) {
      fault.value = error instanceof Error ? error.message : String(error);
    }
  };
  return (
    <section class="place" aria-labelledby={`place-${name}`} data-place={name}>
      <h2 id={`place-${name}`}>{viewLabel(name)}</h2>
      <div class="place-picture">{picture ? <img src={picture.url} alt={messages.measure.ofPicture(pictureOf(name))} /> : <Silhouette view={name} />}</div>
      <div class="place-words">
        {!picture && <p>{words.stances[name]}</p>}
        {fault.value && (
          <p class="note is-problem" role="alert">
            {fault.value}
          </p>
        )}
        {picture?.scaledFrom && <p class="fine">{messages.panel.scaled(sizeOf(picture.scaledFrom))}</p>}
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
              {picture ? words.takeAgain : words.take}
            </button>
          ) : (
            <PictureFile label={picture ? words.takeAgain : words.take} named={words.takeNamed(pictureOf(name))} camera onChoose={take} />
          )}
          <PictureFile label={picture ? words.chooseOther : words.choose} named={words.chooseNamed(pictureOf(name))} onChoose={take} />
        </div>
      </div>
      {films.value && <Camera view={name} onTaken={(photo, title) => void take(photo, title)} onClose={() => (films.value = false)} />}
    </section>
  );
}

/** What is known of the picture so far. */
function Said({ place }: { place: Place }) {
  const { place: words } = messages.measure;
  const { picture, problem, check, isChecking } = place;
  if (!picture.value) return null;
  if (problem.value) return <PictureProblem problem={problem.value} />;
  if (!canPropose.value) return null;
  if (!check.value) return <p class="fine">{words.looking}</p>;
  if (check.value.findings.length > 0) return <Findings findings={check.value.findings} />;
  return (
    <p class="place-good" aria-busy={isChecking.value}>
      <Icon name="check" /> {words.good}
    </p>
  );
}
