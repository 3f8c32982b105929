#include <eunoe/processes/powder_spreading/apparatus.h>

#include <nlohmann/json.hpp>

namespace eunoe::spreading {

std::string Apparatus::as_json(const double density) const
{
  nlohmann::ordered_json json;
  json["x_transfer"] = x_transfer;
  json["x_gap"] = x_gap;
  json["x_plate"] = x_plate;
  json["x_plate_end"] = x_plate_end;
  json["x_exit"] = x_exit;
  json["x_end"] = x_end;
  json["y_bottom"] = y_bottom;
  json["y_top"] = y_top;
  json["depth"] = depth;
  json["side_walls"] = p.side_walls;
  json["lip"] = p.lip;
  json["rim"] = p.rim;
  json["spreader"] = p.spreader;
  json["x_start"] = x_start;
  json["front"] = front;
  json["rear"] = rear;
  json["spreader_height"] = spreader_height;
  json["clearance"] = p.mean_clearance();
  json["n_layers"] = p.n_layers;
  json["layer_thickness"] = p.layer_thickness;
  json["first_thickness"] = p.first_thickness;
  json["plate_stroke"] = p.plate_stroke();
  json["velocity"] = p.velocity;
  json["first_stroke"] = p.actual_stroke(0);
  json["stroke"] = p.actual_stroke(1);
  json["platform_velocity"] = p.platform_velocity;
  json["rest_before_weighing"] = p.rest_before_weighing;
  json["replenished"] = p.feedstock == "replenished";
  json["bed_depth"] = bed_depth;
  json["first_bed_depth"] = first_bed_depth;
  json["bed_level"] = bed_level;
  json["density"] = density;
  return json.dump(2) + "\n";
}

} // namespace eunoe::spreading
