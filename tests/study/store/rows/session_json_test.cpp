#include "study/store/rows/session_json.h"

#include <gtest/gtest.h>

#include <limits>

#include "study/store/schema/sqlite.h"
#include "tests/study/store/fake_study.h"

namespace passung::store {
namespace {

std::string extract(const std::string& json, const std::string& path) {
    const fake::TempFolder folder;
    const Database database(folder / "json.db", OpenMode::Create);
    Statement find = database.prepare("SELECT json_valid(?1), coalesce(json_extract(?1, ?2), 'null')");
    find.bind(json, path).step();
    EXPECT_EQ(find.integer(0), 1) << json;
    return find.text(1);
}

TEST(SessionJson, ADeviceSaysWhatItsMechanismIs) {
    // Truth: independent program (SQLite's JSON functions read what was written)
    DeviceDescription device;
    device.name = "arm";
    device.label = fake::kHardText;
    EXPECT_EQ(extract(deviceJson(device), "$.mechanism"), "null") << "of a real device it is not known";
    device.mechanism = DeviceMechanism{.mass_kg = 0.25,
                                       .inertia_kg_m2 = 5e-4,
                                       .damping_Ns_per_m = 1.5,
                                       .rotational_damping_Nms_per_rad = 0.002,
                                       .coulomb_force_N = 0.125,
                                       .coulomb_torque_Nm = 0.003,
                                       .quantum_m = 1.5e-6,
                                       .rotational_quantum_rad = 2.5e-4};
    const std::string json = deviceJson(device);
    EXPECT_EQ(extract(json, "$.label"), fake::kHardText);
    EXPECT_EQ(extract(json, "$.simulated"), "1");
    EXPECT_EQ(std::stod(extract(json, "$.mechanism.mass_kg")), 0.25);
    EXPECT_EQ(std::stod(extract(json, "$.mechanism.inertia_kg_m2")), 5e-4);
    EXPECT_EQ(std::stod(extract(json, "$.mechanism.damping_Ns_per_m")), 1.5);
    EXPECT_EQ(std::stod(extract(json, "$.mechanism.rotational_damping_Nms_per_rad")), 0.002);
    EXPECT_EQ(std::stod(extract(json, "$.mechanism.coulomb_force_N")), 0.125);
    EXPECT_EQ(std::stod(extract(json, "$.mechanism.coulomb_torque_Nm")), 0.003);
    EXPECT_EQ(std::stod(extract(json, "$.mechanism.quantum_m")), 1.5e-6);
    EXPECT_EQ(std::stod(extract(json, "$.mechanism.rotational_quantum_rad")), 2.5e-4);
    device.max_force_N = std::numeric_limits<double>::infinity();
    EXPECT_EQ(extract(deviceJson(device), "$.max_force_N"), "null");
}

TEST(SessionJson, ARealDeviceSaysWhichUnitItIs) {
    // Truth: independent program (SQLite's JSON functions read what was written); a simulated one has no such key.
    EXPECT_EQ(extract(deviceJson({}), "$.units"), "null");
    const DeviceUnit unit{"right", "sigma7", "dhd", fake::kHardText, "sigma.7", "3.17", "axes x y z"};
    const std::string json = deviceJson({}, std::vector{unit, DeviceUnit{.serial = "2"}});
    EXPECT_EQ(extract(json, "$.units[0].hand"), "right");
    EXPECT_EQ(extract(json, "$.units[0].kind"), "sigma7");
    EXPECT_EQ(extract(json, "$.units[0].backend"), "dhd");
    EXPECT_EQ(extract(json, "$.units[0].serial"), fake::kHardText);
    EXPECT_EQ(extract(json, "$.units[0].model"), "sigma.7");
    EXPECT_EQ(extract(json, "$.units[0].versions"), "3.17");
    EXPECT_EQ(extract(json, "$.units[0].calibration"), "axes x y z");
    EXPECT_EQ(extract(json, "$.units[1].serial"), "2");
}

}  // namespace
}  // namespace passung::store
