// Whether the phone is level, drawn as the line that would be: nothing where the browser does not tell.
import { messages } from "../messages";
import { levelWord, useTilt } from "./level";

export function SpiritLevel({ facesUser }: { facesUser: boolean }) {
  const tilt = useTilt();
  if (!tilt) return null;
  const word = levelWord(tilt, facesUser);
  return (
    <p class={`camera-level ${word ? "" : "is-level"}`}>
      <i style={{ rotate: `${-tilt.roll}deg` }} aria-hidden="true" />
      {word ?? messages.measure.level.level}
    </p>
  );
}
