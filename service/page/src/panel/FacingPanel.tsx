// Limbs of which the clicks do not say whether they come toward the camera.
import type { Facing, Limb } from "../api/types";
import { facing, upcoming } from "../draft/draft";
import { liveBody } from "../draft/live";
import { plainName, wordFor } from "../messages/words";
import { capitalised } from "../messages/figures";
import { messages } from "../messages";
import { Choice } from "../ui/Choice";

export function FacingPanel() {
  const { panel, points } = messages;
  const words = panel.facing;
  const said = facing.value;
  const limbs = liveBody.value?.limbs ?? [];
  const open = limbs.filter((limb) => limb.ambiguous || (limb.limb as Limb) in said);
  if (open.length === 0) return null;
  const undecided = open.filter((limb) => !((limb.limb as Limb) in said)).length;
  return (
    <details class="section fold-section" open={upcoming.value === null && undecided > 0}>
      <summary>
        <h2>{words.title}</h2> <span class="count">{undecided === 0 ? words.allSaid : words.undecided(undecided)}</span>
      </summary>
      <p class="fine">{words.help}</p>
      {open.map((limb) => (
        <Choice<Facing | "open">
          key={limb.limb}
          name={`facing-${limb.limb}`}
          legend={capitalised(wordFor(points.limbs, limb.limb) ?? plainName(limb.limb))}
          options={[
            { value: "open", label: words.open[limb.facing] },
            { value: "toward", label: words.toward },
            { value: "away", label: words.away },
          ]}
          value={said[limb.limb as Limb] ?? "open"}
          onChange={(value) => {
            const { [limb.limb as Limb]: _, ...others } = said;
            facing.value = value === "open" ? others : { ...others, [limb.limb]: value };
          }}
        />
      ))}
    </details>
  );
}
