// In place of the body until it has come: the picture, or the room for it, and how much is there.
import type { Picture } from "../draft/picture";
import { percent } from "../messages/figures";
import { messages } from "../messages";

export function Loading({ picture, loaded }: { picture: Picture | null; loaded: number }) {
  const { look } = messages;
  return (
    <div class="look">
      <div class="look-bar is-coming" />
      <div class="look-room">
        {picture ? <img class="whole-picture" src={picture.url} alt={look.picture} /> : <div class="look-blank" />}
        <LoadingNote loaded={loaded} />
      </div>
    </div>
  );
}

export function LoadingNote({ loaded }: { loaded: number }) {
  const { look } = messages;
  return (
    <div class="look-loading">
      <span>{look.loading(percent(loaded))}</span>
      <progress class="bar" max={1} value={loaded} aria-label={look.loadingBody} />
    </div>
  );
}
