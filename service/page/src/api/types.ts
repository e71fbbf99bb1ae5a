// The wire types, by short names; generated/schema.d.ts is made from the service's own openapi.json.
import type { components } from "../../generated/schema";

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
export type Remark = Schemas["Remark"];
export type UploadedImage = Schemas["UploadedImage"];
export type InitialPose = Schemas["InitialPose"];
export type InitialPoseRequest = Schemas["InitialPoseRequest"];
export type PointsProposal = Schemas["PointsProposal"];
export type PointsRequest = Partial<Schemas["PointsRequest"]>;
export type PointName = PointsProposal["doubtful"][number];
export type NamedMotion = Schemas["NamedMotion"];
export type NamedPose = NonNullable<Schemas["PoseOptions"]["pose"]>;
export type TextureColours = NonNullable<Schemas["TextureOptions"]["colours"]>;
export type TextureSize = NonNullable<Schemas["TextureOptions"]["size"]>;
export type SizeResult = Schemas["SizeResult"];
export type CompositionResult = Schemas["CompositionResult"];
export type ProductKind = Schemas["Product"]["kind"];
export type Product = Schemas["Product"];
export type ProductRequest = Schemas["ProductRequest"];
export type ProductResult = NonNullable<Product["result"]>;
