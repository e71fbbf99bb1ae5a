// Asks where clothes look loose: one line and one button.
import { clothing } from "../draft/draft";
import { messages } from "../messages";
import { announce } from "../ui/announce";
import { looksLoose } from "./clothes";

export function LooseClothesNote() {
  const { loose } = messages.mask;
  if (!looksLoose()) return null;
  const accept = () => {
    clothing.value = "loose";
    announce(loose.said);
  };
  return (
    <div class="note" role="status">
      <p>{loose.question}</p>
      <div class="row">
        <button class="button is-small" type="button" onClick={accept}>
          {loose.yes}
        </button>
      </div>
    </div>
  );
}
