// A fit that is being prepared already: back to it, or rid of it.
import { picture } from "../draft/draft";
import { messages } from "../messages";
import { discard } from "../panel/open";
import { PREPARE_ADDRESS } from "../route";

export function GoOn() {
  const { goOn } = messages.start;
  const shown = picture.value;
  if (!shown) return null;
  return (
    <div class="go-on">
      <img src={shown.url} alt="" />
      <a class="button is-primary" href={PREPARE_ADDRESS}>
        <span>{goOn.with(shown.name)}</span>
      </a>
      <button class="link" type="button" onClick={discard}>
        {goOn.discard}
      </button>
    </div>
  );
}
