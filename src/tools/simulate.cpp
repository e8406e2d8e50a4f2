// SPDX-License-Identifier: BSD-3-Clause
// Writes the sweeps of a simulated lidar, its true trajectory and its mounting to a bag.
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/Odometry.h>
#include <ros/datatypes.h>
#include <rosbag/bag.h>
#include <rosbag/exceptions.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/number_text.hpp"
#include "sim/scanner.hpp"
#include "sim/worlds.hpp"
#include "tools/console.hpp"
#include "tools/options.hpp"

namespace edgevox::sim {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

constexpr std::uint32_t kEpoch = 1700000000;  // s, the stamp of the first sweep
constexpr std::size_t kLargeSweep = 1000000;  // rays
constexpr const char* kWorldFrame = "world";
constexpr const char* kSensorFrame = "lidar";
constexpr const char* kBaseFrame = "base_link";

struct Options {
  std::string world;
  std::string sensor;
  fs::path output;
  std::uint64_t seed = 1;
  bool movers = false;
  std::optional<double> duration;  // s
  std::optional<double> noise;     // m
  std::optional<double> dropout;
  std::optional<double> rate;    // Hz
  std::optional<double> length;  // m
};

void requireRange(const char* name, const std::optional<double>& value, double low, double high) {
  if (!value || (*value >= low && *value <= high)) return;
  throw UsageError(std::string("--") + name + " is " + shortText(*value) + ", allowed is " +
                   shortText(low) + " to " + shortText(high));
}

po::options_description describeOptions() {
  po::options_description description = withHelp(
      "simulate: a lidar's sweeps through a made-up world\n"
      "Building (76 s) and street (81.6 s, longer with --length) end as they begin: same place,\n"
      "same heading, at rest, so that their bags can be played round after round.\n\n"
      "Options");
  auto add = description.add_options();
  add("world", po::value<std::string>()->required(), "building, street, corridor or city");
  add("sensor", po::value<std::string>()->default_value("32"),
      "16, 32 or 64 beams; terrestrial on standing stations: scanner, or fine-scanner, which "
      "sends\n"
      "22.5 million rays from each");
  add("output,o", po::value<std::string>()->required(),
      "bag to write; the trajectory goes beside it as .tum");
  add("seed", po::value<std::int64_t>()->default_value(1), "0 or more; same seed, same bag");
  add("movers", "people walk about and boxes are taken away (building only)");
  add("length", po::value<double>(), "m, of the loop of streets, 520 or more (street only)");
  add("duration", po::value<double>(), "s, stop after so long (default: the whole path)");
  add("noise", po::value<double>(), "m, standard deviation of the range (default: the sensor's)");
  add("dropout", po::value<double>(), "share of returns left out (default: the sensor's)");
  add("rate", po::value<double>(), "sweeps a second (default: 10, scanner 1)");
  return description;
}

// Nothing if help was asked for and given.
std::optional<Options> optionsOf(const Arguments& arguments) {
  const auto parsed = parseOptions(arguments, describeOptions());
  if (!parsed) return std::nullopt;
  const po::variables_map& given = *parsed;
  Options options;
  options.world = given["world"].as<std::string>();
  options.sensor = given["sensor"].as<std::string>();
  options.output = given["output"].as<std::string>();
  options.seed = countOf(given, "seed", 0);
  options.movers = given.count("movers") > 0;
  options.length = numberOf(given, "length");
  options.duration = numberOf(given, "duration");
  options.noise = numberOf(given, "noise");
  options.dropout = numberOf(given, "dropout");
  options.rate = numberOf(given, "rate");
  requireRange("length", options.length, kStreetLength, 1e5);
  requireRange("duration", options.duration, 0.0, 1e5);
  requireRange("noise", options.noise, 0.0, 1.0);
  requireRange("dropout", options.dropout, 0.0, 1.0);
  requireRange("rate", options.rate, 0.01, 100.0);
  if (options.output.extension() != ".bag") {
    throw UsageError("--output must end in .bag");
  }
  return options;
}

Sensor configureSensor(const Options& options) {
  Sensor sensor = makeSensor(options.sensor);
  sensor.noise = options.noise.value_or(sensor.noise);
  sensor.dropout = options.dropout.value_or(sensor.dropout);
  if (options.rate) sensor.period = 1.0 / *options.rate;
  return sensor;
}

ros::Time stampOf(double seconds) {
  const auto nanoseconds = static_cast<std::uint64_t>(std::llround(seconds * 1e9));
  return ros::Time(kEpoch + static_cast<std::uint32_t>(nanoseconds / 1000000000u),
                   static_cast<std::uint32_t>(nanoseconds % 1000000000u));
}

sensor_msgs::PointField makeField(const char* name, std::uint32_t offset, std::uint8_t type) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = offset;
  field.datatype = type;
  field.count = 1;
  return field;
}

sensor_msgs::PointCloud2 toCloud(const Scan& scan, std::uint32_t sequence) {
  using Field = sensor_msgs::PointField;
  sensor_msgs::PointCloud2 cloud;
  cloud.header.seq = sequence;
  cloud.header.stamp = stampOf(scan.stamp);
  cloud.header.frame_id = kSensorFrame;
  cloud.fields = {makeField("x", 0, Field::FLOAT32),    makeField("y", 4, Field::FLOAT32),
                  makeField("z", 8, Field::FLOAT32),    makeField("intensity", 12, Field::FLOAT32),
                  makeField("ring", 16, Field::UINT16), makeField("time", 20, Field::FLOAT32)};
  cloud.point_step = 24;
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(scan.size());
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.is_bigendian = 0;
  cloud.is_dense = 1;
  cloud.data.resize(cloud.row_step);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    std::uint8_t* point = &cloud.data[i * cloud.point_step];
    std::memcpy(point, scan.points[i].data(), 12);
    std::memcpy(point + 12, &scan.intensities[i], 4);
    std::memcpy(point + 16, &scan.rings[i], 2);
    std::memcpy(point + 20, &scan.times[i], 4);
  }
  return cloud;
}

template <typename Message>
void assign(const Eigen::Vector3d& vector, Message& message) {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

// Velocity in the sensor's frame.
geometry_msgs::Twist twistAt(const Trajectory& trajectory, double time) {
  constexpr double kHalfStep = 0.005;  // s, of the difference that gives the velocity
  const Eigen::Isometry3d before = trajectory.poseAt(time - kHalfStep);
  const Eigen::Isometry3d after = trajectory.poseAt(time + kHalfStep);
  const Eigen::Vector3d velocity = trajectory.poseAt(time).linear().transpose() *
                                   (after.translation() - before.translation()) / (2 * kHalfStep);
  const Eigen::AngleAxisd turn(before.linear().transpose() * after.linear());
  const Eigen::Vector3d rate = turn.axis() * turn.angle() / (2 * kHalfStep);
  geometry_msgs::Twist twist;
  assign(velocity, twist.linear);
  assign(rate, twist.angular);
  return twist;
}

// Without the velocity; the covariances are zero, as this is the truth.
nav_msgs::Odometry toOdometry(const Trajectory& trajectory, double time, std::uint32_t sequence) {
  const Eigen::Isometry3d T_world_sensor = trajectory.poseAt(time);
  const Eigen::Quaterniond q(T_world_sensor.linear());
  nav_msgs::Odometry odometry;
  odometry.header.seq = sequence;
  odometry.header.stamp = stampOf(time);
  odometry.header.frame_id = kWorldFrame;
  odometry.child_frame_id = kSensorFrame;
  assign(T_world_sensor.translation(), odometry.pose.pose.position);
  assign(q.vec(), odometry.pose.pose.orientation);
  odometry.pose.pose.orientation.w = q.w();
  return odometry;
}

void writeMounting(rosbag::Bag& bag, double height) {
  geometry_msgs::TransformStamped mounting;
  mounting.header.stamp = stampOf(0.0);
  mounting.header.frame_id = kBaseFrame;
  mounting.child_frame_id = kSensorFrame;
  mounting.transform.translation.z = height;
  mounting.transform.rotation.w = 1.0;
  tf2_msgs::TFMessage message;
  message.transforms.push_back(mounting);
  namespace traits = ros::message_traits;
  auto header = boost::make_shared<ros::M_string>();
  (*header)["type"] = traits::datatype(message);
  (*header)["md5sum"] = traits::md5sum(message);
  (*header)["message_definition"] = traits::definition(message);
  (*header)["latching"] = "1";
  bag.write("/tf_static", stampOf(0.0), message, header);
}

// stamp tx ty tz qx qy qz qw of T_world_sensor.
std::string tumLine(const nav_msgs::Odometry& odometry) {
  const auto& p = odometry.pose.pose.position;
  const auto& q = odometry.pose.pose.orientation;
  char line[256];
  std::snprintf(line, sizeof line, "%u.%09u %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n",
                odometry.header.stamp.sec, odometry.header.stamp.nsec, p.x, p.y, p.z, q.x, q.y, q.z,
                q.w);
  return line;
}

struct Run {
  World world;
  Movers movers;
  Sensor sensor;
  Trajectory trajectory;
  int sweeps;
};

Run prepareRun(const Options& options) {
  const WorldName name = parseWorldName(options.world);
  const Sensor sensor = configureSensor(options);
  if (options.length && name != WorldName::Street) {
    throw std::invalid_argument("--length is for the street only");
  }
  const double length = options.length.value_or(kStreetLength);
  Trajectory trajectory = makeTrajectory(name, sensor, length);
  int sweeps = countSweeps(trajectory, sensor);
  if (options.duration) {
    sweeps =
        std::min(sweeps, static_cast<int>(std::floor(*options.duration / sensor.period + 1e-9)));
  }
  if (sweeps < 1) throw UsageError("--duration is shorter than one sweep");
  Movers movers = options.movers ? makeMovers(name, options.seed) : Movers{};
  return {makeWorld(name, options.seed, length), std::move(movers), sensor, std::move(trajectory),
          sweeps};
}

volatile std::sig_atomic_t interrupted = 0;

// Gives the trajectory in TUM format.
std::string writeSweeps(const Run& run, std::uint64_t seed, rosbag::Bag& bag, Console& console) {
  const unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  const bool large = run.sensor.elevations.size() * run.sensor.columns > kLargeSweep;
  const int batch = static_cast<int>(large ? threads : 2 * threads);
  std::string tum;
  for (int first = 0; first < run.sweeps; first += batch) {
    const int count = std::min(batch, run.sweeps - first);
    const auto scans = simulateSweeps(run.world, run.trajectory, run.sensor, first, count, seed,
                                      threads, run.movers);
    for (const Scan& scan : scans) {
      const auto sequence = static_cast<std::uint32_t>(first + (&scan - scans.data()));
      nav_msgs::Odometry truth = toOdometry(run.trajectory, scan.stamp, sequence);
      if (!run.sensor.standing) truth.twist.twist = twistAt(run.trajectory, scan.stamp);
      bag.write("/ground_truth", truth.header.stamp, truth);
      bag.write("/points", truth.header.stamp, toCloud(scan, sequence));
      tum += tumLine(truth);
    }
    if (interrupted != 0) throw std::runtime_error("interrupted, nothing was written");
    console.showProgress(static_cast<size_t>(first + count), static_cast<size_t>(run.sweeps));
  }
  return tum;
}

// rosbag's destructor closes the bag, and throws, which ends the program, if that fails: a bag that
// could not be written is therefore never destroyed.
template <typename Write>
void writeBag(const fs::path& file, const Write& write) {
  auto bag = std::make_unique<rosbag::Bag>();
  try {
    bag->open(file.string(), rosbag::bagmode::Write);
    bag->setCompression(rosbag::compression::LZ4);
    write(*bag);
    bag->close();
  } catch (...) {
    static_cast<void>(bag.release());
    throw;
  }
}

void simulate(const Options& options, Console& console) {
  const Run run = prepareRun(options);
  AtomicFile bag_file(options.output);
  std::string tum;
  try {
    writeBag(bag_file.temporary(), [&](rosbag::Bag& bag) {
      writeMounting(bag, sensorHeight(parseWorldName(options.world)));
      tum = writeSweeps(run, options.seed, bag, console);
    });
  } catch (const rosbag::BagException& error) {
    throw FileError("cannot write '" + options.output.string() + "' (" + error.what() +
                    "); check that its folder exists, may be written to and has space left");
  }
  writeFile(fs::path(options.output).replace_extension(".tum"), tum);
  bag_file.keep();
}

int run(const Arguments& arguments) {
  const auto options = optionsOf(arguments);
  if (!options) return 0;
  Console console(std::cerr, isatty(STDERR_FILENO) != 0, "sweeps");
  simulate(*options, console);
  return 0;
}

}  // namespace
}  // namespace edgevox::sim

int main(int argc, char** argv) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int) { edgevox::sim::interrupted = 1; });
  }
  return edgevox::runTool("simulate", argc, argv, edgevox::sim::run);
}
