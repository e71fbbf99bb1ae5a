// Without a gender there is no outline: what is missing, and the way to it.
import { messages } from "../messages";
import { isFull } from "../stage/full";

export function BodyLink() {
  return (
    <button class="link" type="button" onClick={show}>
      {messages.panel.points.outlineNeedsBody}
    </button>
  );
}

function show(): void {
  isFull.value = false;
  // Nothing beside a full screen takes the focus before it is left.
  requestAnimationFrame(() => {
    const choice = document.querySelector<HTMLElement>(".bench input[name=gender]");
    choice?.focus();
    choice?.scrollIntoView({ block: "center" });
  });
}
