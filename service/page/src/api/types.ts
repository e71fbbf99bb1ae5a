// The wire types, by short names; schema.d.ts is made from the service's own openapi.json.
import type { components } from "./schema";

type Schemas = components["schemas"];

export type Problem = Schemas["Problem"];
export type JobState = Schemas["JobState"];
export type Fit = Schemas["Fit"];
export type FitRequest = Partial<Schemas["FitRequest"]> & Pick<Schemas["FitRequest"], "gender">;
export type ViewRequest = Partial<Schemas["ViewRequest"]>;
export type ViewKind = Schemas["ViewKind"];
export type KnownMeasurements = NonNullable<FitRequest["measurements"]>;
export type Gender = Schemas["Gender"];
export type Cues = Schemas["Cues"];
export type Clothing = Schemas["Clothing"];
export type Limb = Schemas["Limb"];
export type Facing = Schemas["Facing"];
export type EventData = Schemas["EventData"];
export type FitResult = Schemas["FitResult"];
export type ViewResult = Schemas["ViewResult"];
export type Measurement = Schemas["Measurement"];
export type Finding = Schemas["Finding"];
export type FitWarning = Schemas["FitWarning"];
export type Assumption = Schemas["Assumption"];
export type UploadedImage = Schemas["UploadedImage"];
export type InitialPose = Schemas["InitialPose"];
export type InitialPoseRequest = Schemas["InitialPoseRequest"];
export type PointsProposal = Schemas["PointsProposal"] & { readonly findings?: readonly Finding[] };
export type PointsOfImage = Schemas["PointsOfImage"];
export type PointName = NonNullable<Finding["points"]>[number];
export type NamedMotion = Schemas["NamedMotion"];
export type NamedPose = Schemas["NamedPose"];
export type TextureColours = Schemas["TextureColours"];
export type TextureSize = NonNullable<Schemas["TextureOptions"]["size"]>;
export type SizeResult = Schemas["SizeResult"];

export type ProductKind = "texture" | "pose" | "animation" | "caricature" | "print" | "size" | "composition";

export interface ProductRequest {
  readonly kind: ProductKind;
  readonly [option: string]: unknown;
}

export interface Product {
  readonly id: string;
  readonly kind: ProductKind;
  readonly fit_id: string;
  readonly state: JobState;
  readonly progress: number;
  readonly problem: Problem | null;
  readonly result: { readonly kind: string } | null;
  readonly links: { readonly self: string; readonly fit: string; readonly files: Readonly<Record<string, string>> };
}
