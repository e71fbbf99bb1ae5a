// What the person is called, so that their fits and scans are found together.
import { person } from "../draft/draft";
import { messages } from "../messages/language";
import { isEmbedded } from "../route";
import { knownLabels, lookForPeople } from "./known";

const LONGEST = 80;

/** In a frame of another site there is none: that site knows whom it has measured. */
export function LabelField() {
  const { people: words } = messages.value;
  const label = person.value.label.trim();
  if (isEmbedded) return null;
  return (
    <details class="fold">
      <summary>
        {words.fold} {label && <span class="count">{label}</span>}
      </summary>
      <div class="field">
        <label for="person-label">{words.name}</label>
        <input
          id="person-label"
          type="text"
          list="known-people"
          autocomplete="off"
          maxLength={LONGEST}
          value={person.value.label}
          aria-describedby="person-label-note"
          onFocus={() => void lookForPeople()}
          onInput={(event) => (person.value = { ...person.value, label: event.currentTarget.value })}
        />
        <datalist id="known-people">
          {knownLabels.value.map((label) => (
            <option key={label} value={label} />
          ))}
        </datalist>
      </div>
      <p id="person-label-note" class="fine">
        {words.nameNote}
      </p>
    </details>
  );
}
