// Limbs of which the clicks do not say whether they come toward the camera.
import type { Facing, Limb } from "../api/types";
import { facing, upcoming } from "../draft/draft";
import { liveBody } from "../draft/live";
import { Choice } from "../ui/Choice";

export function FacingPanel() {
  const said = facing.value;
  const limbs = liveBody.value?.limbs ?? [];
  const open = limbs.filter((limb) => limb.ambiguous || (limb.limb as Limb) in said);
  if (open.length === 0) return null;
  const undecided = open.filter((limb) => !((limb.limb as Limb) in said)).length;
  return (
    <details class="section fold-section" open={upcoming.value === null && undecided > 0}>
      <summary>
        <h2>Toward you or away</h2> <span class="count">{undecided === 0 ? "all said" : `${undecided} undecided`}</span>
      </summary>
      <p class="fine">A picture is flat: the hand’s or foot’s end of these limbs may be nearer to you than the other, or farther away. Say so if you see it; this is what goes wrong most often.</p>
      {open.map((limb) => (
        <Choice<Facing | "open">
          key={limb.limb}
          name={`facing-${limb.limb}`}
          legend={capitalised(limb.limb.replaceAll("_", " "))}
          options={[
            { value: "open", label: `Undecided (${limb.facing})` },
            { value: "toward", label: "Toward" },
            { value: "away", label: "Away" },
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

function capitalised(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
