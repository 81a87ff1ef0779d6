// The register map of the TMS320F2808, as far as the drive uses it: word addresses, fields, vector numbers.
//
// This is the one list of addresses: the drivers in this folder and the virtual chip both read it.
//
// Conventions: REG_x is a word address in data space. Peripherals with several instances have a base and offsets:
// EPWM_BASE(3) + EPWM_CMPB. For a field, x_LSB is its lowest bit and x_MASK its mask in place.
// A register marked (EALLOW) ignores writes unless protection has been lifted; (32) has two words, low word first.

#ifndef STILLSPIN_HAL_F2808_REGISTERS_H
#define STILLSPIN_HAL_F2808_REGISTERS_H

#include <stdint.h>

// ---- System control: PLL, clocks, watchdog, low-power modes ------------------------------------------
#define REG_XCLK 0x7010uL  // clock output divider control (EALLOW)
#define XCLK_XCLKOUTDIV_LSB 0
#define XCLK_XCLKOUTDIV_MASK 0x0003u
#define XCLK_XCLKOUTDAT_LSB 2
#define XCLK_XCLKOUTDAT_MASK 0x0004u
#define XCLK_X1DAT_LSB 3
#define XCLK_X1DAT_MASK 0x0008u
#define XCLK_XCLKINDAT_LSB 4
#define XCLK_XCLKINDAT_MASK 0x0010u
#define XCLK_X1CNT_LSB 8
#define XCLK_X1CNT_MASK 0x0F00u
#define XCLK_XCLKINCNT_LSB 12
#define XCLK_XCLKINCNT_MASK 0xF000u
#define REG_PLLSTS 0x7011uL  // PLL status and divide control (EALLOW)
#define PLLSTS_PLLLOCKS_LSB 0
#define PLLSTS_PLLLOCKS_MASK 0x0001u
#define PLLSTS_CLKINDIV_LSB 1
#define PLLSTS_CLKINDIV_MASK 0x0002u
#define PLLSTS_PLLOFF_LSB 2
#define PLLSTS_PLLOFF_MASK 0x0004u
#define PLLSTS_MCLKSTS_LSB 3
#define PLLSTS_MCLKSTS_MASK 0x0008u
#define PLLSTS_MCLKCLR_LSB 4
#define PLLSTS_MCLKCLR_MASK 0x0010u
#define PLLSTS_OSCOFF_LSB 5
#define PLLSTS_OSCOFF_MASK 0x0020u
#define PLLSTS_MCLKOFF_LSB 6
#define PLLSTS_MCLKOFF_MASK 0x0040u
#define REG_HISPCP 0x701AuL  // high-speed peripheral prescaler (EALLOW)
#define HISPCP_HSPCLK_LSB 0
#define HISPCP_HSPCLK_MASK 0x0007u
#define REG_LOSPCP 0x701BuL  // low-speed peripheral prescaler (EALLOW)
#define LOSPCP_LSPCLK_LSB 0
#define LOSPCP_LSPCLK_MASK 0x0007u
#define REG_PCLKCR0 0x701CuL  // peripheral clock gates 0 (EALLOW)
#define PCLKCR0_TBCLKSYNC_LSB 2
#define PCLKCR0_TBCLKSYNC_MASK 0x0004u
#define PCLKCR0_ADCENCLK_LSB 3
#define PCLKCR0_ADCENCLK_MASK 0x0008u
#define PCLKCR0_I2CAENCLK_LSB 4
#define PCLKCR0_I2CAENCLK_MASK 0x0010u
#define PCLKCR0_SPICENCLK_LSB 6
#define PCLKCR0_SPICENCLK_MASK 0x0040u
#define PCLKCR0_SPIDENCLK_LSB 7
#define PCLKCR0_SPIDENCLK_MASK 0x0080u
#define PCLKCR0_SPIAENCLK_LSB 8
#define PCLKCR0_SPIAENCLK_MASK 0x0100u
#define PCLKCR0_SPIBENCLK_LSB 9
#define PCLKCR0_SPIBENCLK_MASK 0x0200u
#define PCLKCR0_SCIAENCLK_LSB 10
#define PCLKCR0_SCIAENCLK_MASK 0x0400u
#define PCLKCR0_SCIBENCLK_LSB 11
#define PCLKCR0_SCIBENCLK_MASK 0x0800u
#define PCLKCR0_ECANAENCLK_LSB 14
#define PCLKCR0_ECANAENCLK_MASK 0x4000u
#define PCLKCR0_ECANBENCLK_LSB 15
#define PCLKCR0_ECANBENCLK_MASK 0x8000u
#define REG_PCLKCR1 0x701DuL  // peripheral clock gates 1 (EALLOW)
#define PCLKCR1_EPWM1ENCLK_LSB 0
#define PCLKCR1_EPWM1ENCLK_MASK 0x0001u
#define PCLKCR1_EPWM2ENCLK_LSB 1
#define PCLKCR1_EPWM2ENCLK_MASK 0x0002u
#define PCLKCR1_EPWM3ENCLK_LSB 2
#define PCLKCR1_EPWM3ENCLK_MASK 0x0004u
#define PCLKCR1_EPWM4ENCLK_LSB 3
#define PCLKCR1_EPWM4ENCLK_MASK 0x0008u
#define PCLKCR1_EPWM5ENCLK_LSB 4
#define PCLKCR1_EPWM5ENCLK_MASK 0x0010u
#define PCLKCR1_EPWM6ENCLK_LSB 5
#define PCLKCR1_EPWM6ENCLK_MASK 0x0020u
#define PCLKCR1_ECAP1ENCLK_LSB 8
#define PCLKCR1_ECAP1ENCLK_MASK 0x0100u
#define PCLKCR1_ECAP2ENCLK_LSB 9
#define PCLKCR1_ECAP2ENCLK_MASK 0x0200u
#define PCLKCR1_ECAP3ENCLK_LSB 10
#define PCLKCR1_ECAP3ENCLK_MASK 0x0400u
#define PCLKCR1_ECAP4ENCLK_LSB 11
#define PCLKCR1_ECAP4ENCLK_MASK 0x0800u
#define PCLKCR1_EQEP1ENCLK_LSB 14
#define PCLKCR1_EQEP1ENCLK_MASK 0x4000u
#define PCLKCR1_EQEP2ENCLK_LSB 15
#define PCLKCR1_EQEP2ENCLK_MASK 0x8000u
#define REG_LPMCR0 0x701EuL  // low power mode select (EALLOW)
#define LPMCR0_LPM_LSB 0
#define LPMCR0_LPM_MASK 0x0003u
#define LPMCR0_QUALSTDBY_LSB 2
#define LPMCR0_QUALSTDBY_MASK 0x00FCu
#define LPMCR0_WDINTE_LSB 15
#define LPMCR0_WDINTE_MASK 0x8000u
#define REG_PLLCR 0x7021uL  // PLL multiplier (EALLOW)
#define PLLCR_DIV_LSB 0
#define PLLCR_DIV_MASK 0x000Fu
#define REG_SCSR 0x7022uL  // watchdog override and interrupt status (EALLOW)
#define SCSR_WDOVERRIDE_LSB 0
#define SCSR_WDOVERRIDE_MASK 0x0001u
#define SCSR_WDENINT_LSB 1
#define SCSR_WDENINT_MASK 0x0002u
#define SCSR_WDINTS_LSB 2
#define SCSR_WDINTS_MASK 0x0004u
#define REG_WDCNTR 0x7023uL  // watchdog up-counter, 8 bit (EALLOW)
#define WDCNTR_WDCNTR_LSB 0
#define WDCNTR_WDCNTR_MASK 0x00FFu
#define REG_WDKEY 0x7025uL  // watchdog service key port (EALLOW)
#define WDKEY_WDKEY_LSB 0
#define WDKEY_WDKEY_MASK 0x00FFu
#define REG_WDCR 0x7029uL  // watchdog control (EALLOW)
#define WDCR_WDPS_LSB 0
#define WDCR_WDPS_MASK 0x0007u
#define WDCR_WDCHK_LSB 3
#define WDCR_WDCHK_MASK 0x0038u
#define WDCR_WDDIS_LSB 6
#define WDCR_WDDIS_MASK 0x0040u
#define WDCR_WDFLAG_LSB 7
#define WDCR_WDFLAG_MASK 0x0080u

// ---- Device identification ---------------------------------------------------------------------------
#define REG_DEVICECNF 0x0880uL  // device configuration bits (EALLOW, 32)
#define DEVICECNF_VMAPS_LSB 3
#define DEVICECNF_VMAPS_MASK 0x0008u
#define DEVICECNF_XRSn_LSB 5
#define DEVICECNF_XRSn_MASK 0x0020u
#define DEVICECNF_ENPROT_LSB 19
#define DEVICECNF_ENPROT_MASK 0x80000uL
#define REG_PARTID 0x0882uL  // device part number
#define PARTID_PARTNO_LSB 0
#define PARTID_PARTNO_MASK 0x00FFu
#define PARTID_PARTTYPE_LSB 8
#define PARTID_PARTTYPE_MASK 0xFF00u
#define REG_REVID 0x0883uL      // silicon revision number
#define REG_PROTSTART 0x0884uL  // block protection start (EALLOW)
#define REG_PROTRANGE 0x0885uL  // block protection range (EALLOW)

// ---- Flash wait states -------------------------------------------------------------------------------
#define REG_FOPT 0x0A80uL  // flash prefetch option (EALLOW)
#define FOPT_ENPIPE_LSB 0
#define FOPT_ENPIPE_MASK 0x0001u
#define REG_FPWR 0x0A82uL  // flash power mode request (EALLOW)
#define FPWR_PWR_LSB 0
#define FPWR_PWR_MASK 0x0003u
#define REG_FSTATUS 0x0A83uL  // flash power and wait status (EALLOW)
#define FSTATUS_PWRS_LSB 0
#define FSTATUS_PWRS_MASK 0x0003u
#define FSTATUS_STDBYWAITS_LSB 2
#define FSTATUS_STDBYWAITS_MASK 0x0004u
#define FSTATUS_ACTIVEWAITS_LSB 3
#define FSTATUS_ACTIVEWAITS_MASK 0x0008u
#define FSTATUS_V3STAT_LSB 8
#define FSTATUS_V3STAT_MASK 0x0100u
#define REG_FSTDBYWAIT 0x0A84uL  // sleep to standby wait count (EALLOW)
#define FSTDBYWAIT_STDBYWAIT_LSB 0
#define FSTDBYWAIT_STDBYWAIT_MASK 0x01FFu
#define REG_FACTIVEWAIT 0x0A85uL  // standby to active wait count (EALLOW)
#define FACTIVEWAIT_ACTIVEWAIT_LSB 0
#define FACTIVEWAIT_ACTIVEWAIT_MASK 0x01FFu
#define REG_FBANKWAIT 0x0A86uL  // flash read wait states (EALLOW)
#define FBANKWAIT_RANDWAIT_LSB 0
#define FBANKWAIT_RANDWAIT_MASK 0x000Fu
#define FBANKWAIT_PAGEWAIT_LSB 8
#define FBANKWAIT_PAGEWAIT_MASK 0x0F00u
#define REG_FOTPWAIT 0x0A87uL  // OTP read wait states (EALLOW)
#define FOTPWAIT_OTPWAIT_LSB 0
#define FOTPWAIT_OTPWAIT_MASK 0x001Fu

// ---- Code security -----------------------------------------------------------------------------------
// Passwords that are all ones are no lock: eight reads of them open the chip. All zeros lock it for ever.
#define REG_KEY(n) (0x0AE0uL + (uint32_t)(n))  // 0..7: compared with the passwords (EALLOW)
#define REG_CSMSCR 0x0AEFuL                    // security status (EALLOW)
#define CSMSCR_SECURE_LSB 0
#define CSMSCR_SECURE_MASK 0x0001u
#define CSMSCR_FORCESEC_LSB 15
#define CSMSCR_FORCESEC_MASK 0x8000u
#define REG_PSWD(n) (0x3F7FF8uL + (uint32_t)(n))  // 0..7: in the flash

// ---- Peripheral interrupt expansion ------------------------------------------------------------------
#define REG_PIECTRL 0x0CE0uL  // PIE enable, last vector
#define PIECTRL_ENPIE_LSB 0
#define PIECTRL_ENPIE_MASK 0x0001u
#define PIECTRL_PIEVECT_LSB 1
#define PIECTRL_PIEVECT_MASK 0xFFFEu
#define REG_PIEACK 0x0CE1uL                                                        // group acknowledge, write 1 clears
#define REG_PIEIER(group) ((uint32_t)(0x0CE2uL + 2uL * (uint32_t)((group) - 1u)))  // group 1..12, bit INTx.y - 1
#define REG_PIEIFR(group) ((uint32_t)(0x0CE3uL + 2uL * (uint32_t)((group) - 1u)))  // group 1..12, bit INTx.y - 1

// ---- CPU timers 0, 1, 2 ------------------------------------------------------------------------------
#define CPUTIMER_BASE(n) ((uint32_t)(0x0C00uL + 0x08uL * (uint32_t)((n))))
#define CPUTIMER_TIM 0x00u      // down-counter value (32)
#define CPUTIMER_TIM_LSW 0x00u  // low word
#define CPUTIMER_TIM_MSW 0x01u  // high word
#define CPUTIMER_PRD 0x02u      // reload period (32)
#define CPUTIMER_PRD_LSW 0x02u  // low word
#define CPUTIMER_PRD_MSW 0x03u  // high word
#define CPUTIMER_TCR 0x04u      // timer control
#define CPUTIMER_TCR_TSS_LSB 4
#define CPUTIMER_TCR_TSS_MASK 0x0010u
#define CPUTIMER_TCR_TRB_LSB 5
#define CPUTIMER_TCR_TRB_MASK 0x0020u
#define CPUTIMER_TCR_SOFT_LSB 10
#define CPUTIMER_TCR_SOFT_MASK 0x0400u
#define CPUTIMER_TCR_FREE_LSB 11
#define CPUTIMER_TCR_FREE_MASK 0x0800u
#define CPUTIMER_TCR_TIE_LSB 14
#define CPUTIMER_TCR_TIE_MASK 0x4000u
#define CPUTIMER_TCR_TIF_LSB 15
#define CPUTIMER_TCR_TIF_MASK 0x8000u
#define CPUTIMER_TPR 0x06u  // prescaler low byte pair
#define CPUTIMER_TPR_TDDR_LSB 0
#define CPUTIMER_TPR_TDDR_MASK 0x00FFu
#define CPUTIMER_TPR_PSC_LSB 8
#define CPUTIMER_TPR_PSC_MASK 0xFF00u
#define CPUTIMER_TPRH 0x07u  // prescaler high byte pair
#define CPUTIMER_TPRH_TDDRH_LSB 0
#define CPUTIMER_TPRH_TDDRH_MASK 0x00FFu
#define CPUTIMER_TPRH_PSCH_LSB 8
#define CPUTIMER_TPRH_PSCH_MASK 0xFF00u

// ---- General purpose pins ----------------------------------------------------------------------------
#define REG_GPACTRL 0x6F80uL       // port A qualification sampling periods (EALLOW, 32)
#define REG_GPAQSEL1 0x6F82uL      // GPIO0-15 input qualification (EALLOW, 32)
#define REG_GPAQSEL2 0x6F84uL      // GPIO16-31 input qualification (EALLOW, 32)
#define REG_GPAMUX1 0x6F86uL       // GPIO0-15 function select (EALLOW, 32)
#define REG_GPAMUX2 0x6F88uL       // GPIO16-31 function select (EALLOW, 32)
#define REG_GPADIR 0x6F8AuL        // port A direction, 1 output (EALLOW, 32)
#define REG_GPAPUD 0x6F8CuL        // port A pull-up disable (EALLOW, 32)
#define REG_GPBCTRL 0x6F90uL       // port B qualification sampling period (EALLOW, 32)
#define REG_GPBQSEL1 0x6F92uL      // GPIO32-34 input qualification (EALLOW, 32)
#define REG_GPBQSEL2 0x6F94uL      // reserved (EALLOW, 32)
#define REG_GPBMUX1 0x6F96uL       // GPIO32-34 function select (EALLOW, 32)
#define REG_GPBMUX2 0x6F98uL       // reserved (EALLOW, 32)
#define REG_GPBDIR 0x6F9AuL        // port B direction (EALLOW, 32)
#define REG_GPBPUD 0x6F9CuL        // port B pull-up disable (EALLOW, 32)
#define REG_GPADAT 0x6FC0uL        // port A pin state / latch (32)
#define REG_GPASET 0x6FC2uL        // port A write-1 set (32)
#define REG_GPACLEAR 0x6FC4uL      // port A write-1 clear (32)
#define REG_GPATOGGLE 0x6FC6uL     // port A write-1 toggle (32)
#define REG_GPBDAT 0x6FC8uL        // port B pin state / latch (32)
#define REG_GPBSET 0x6FCAuL        // port B write-1 set (32)
#define REG_GPBCLEAR 0x6FCCuL      // port B write-1 clear (32)
#define REG_GPBTOGGLE 0x6FCEuL     // port B write-1 toggle (32)
#define REG_GPIOXINT1SEL 0x6FE0uL  // pin feeding XINT1 (EALLOW)
#define REG_GPIOXINT2SEL 0x6FE1uL  // pin feeding XINT2 (EALLOW)
#define REG_GPIOXNMISEL 0x6FE2uL   // pin feeding XNMI (EALLOW)
#define REG_GPIOLPMSEL 0x6FE8uL    // wake-up pin selection (EALLOW, 32)

// ---- Analog-to-digital converter ---------------------------------------------------------------------
#define REG_ADCTRL1 0x7100uL  // ADC control 1
#define ADCTRL1_SEQ_CASC_LSB 4
#define ADCTRL1_SEQ_CASC_MASK 0x0010u
#define ADCTRL1_SEQ_OVRD_LSB 5
#define ADCTRL1_SEQ_OVRD_MASK 0x0020u
#define ADCTRL1_CONT_RUN_LSB 6
#define ADCTRL1_CONT_RUN_MASK 0x0040u
#define ADCTRL1_CPS_LSB 7
#define ADCTRL1_CPS_MASK 0x0080u
#define ADCTRL1_ACQ_PS_LSB 8
#define ADCTRL1_ACQ_PS_MASK 0x0F00u
#define ADCTRL1_SUSMOD_LSB 12
#define ADCTRL1_SUSMOD_MASK 0x3000u
#define ADCTRL1_RESET_LSB 14
#define ADCTRL1_RESET_MASK 0x4000u
#define REG_ADCTRL2 0x7101uL  // ADC control 2, triggers
#define ADCTRL2_EPWM_SOCB_SEQ2_LSB 0
#define ADCTRL2_EPWM_SOCB_SEQ2_MASK 0x0001u
#define ADCTRL2_INT_MOD_SEQ2_LSB 2
#define ADCTRL2_INT_MOD_SEQ2_MASK 0x0004u
#define ADCTRL2_INT_ENA_SEQ2_LSB 3
#define ADCTRL2_INT_ENA_SEQ2_MASK 0x0008u
#define ADCTRL2_SOC_SEQ2_LSB 5
#define ADCTRL2_SOC_SEQ2_MASK 0x0020u
#define ADCTRL2_RST_SEQ2_LSB 6
#define ADCTRL2_RST_SEQ2_MASK 0x0040u
#define ADCTRL2_EXT_SOC_SEQ1_LSB 7
#define ADCTRL2_EXT_SOC_SEQ1_MASK 0x0080u
#define ADCTRL2_EPWM_SOCA_SEQ1_LSB 8
#define ADCTRL2_EPWM_SOCA_SEQ1_MASK 0x0100u
#define ADCTRL2_INT_MOD_SEQ1_LSB 10
#define ADCTRL2_INT_MOD_SEQ1_MASK 0x0400u
#define ADCTRL2_INT_ENA_SEQ1_LSB 11
#define ADCTRL2_INT_ENA_SEQ1_MASK 0x0800u
#define ADCTRL2_SOC_SEQ1_LSB 13
#define ADCTRL2_SOC_SEQ1_MASK 0x2000u
#define ADCTRL2_RST_SEQ1_LSB 14
#define ADCTRL2_RST_SEQ1_MASK 0x4000u
#define ADCTRL2_EPWM_SOCB_SEQ_LSB 15
#define ADCTRL2_EPWM_SOCB_SEQ_MASK 0x8000u
#define REG_ADCMAXCONV 0x7102uL  // number of conversions minus one
#define ADCMAXCONV_MAX_CONV1_LSB 0
#define ADCMAXCONV_MAX_CONV1_MASK 0x000Fu
#define ADCMAXCONV_MAX_CONV2_LSB 4
#define ADCMAXCONV_MAX_CONV2_MASK 0x0070u
#define REG_ADCCHSELSEQ1 0x7103uL  // channel select slots 0-3
#define ADCCHSELSEQ1_CONV00_LSB 0
#define ADCCHSELSEQ1_CONV00_MASK 0x000Fu
#define ADCCHSELSEQ1_CONV01_LSB 4
#define ADCCHSELSEQ1_CONV01_MASK 0x00F0u
#define ADCCHSELSEQ1_CONV02_LSB 8
#define ADCCHSELSEQ1_CONV02_MASK 0x0F00u
#define ADCCHSELSEQ1_CONV03_LSB 12
#define ADCCHSELSEQ1_CONV03_MASK 0xF000u
#define REG_ADCCHSELSEQ2 0x7104uL  // channel select slots 4-7
#define ADCCHSELSEQ2_CONV04_LSB 0
#define ADCCHSELSEQ2_CONV04_MASK 0x000Fu
#define ADCCHSELSEQ2_CONV05_LSB 4
#define ADCCHSELSEQ2_CONV05_MASK 0x00F0u
#define ADCCHSELSEQ2_CONV06_LSB 8
#define ADCCHSELSEQ2_CONV06_MASK 0x0F00u
#define ADCCHSELSEQ2_CONV07_LSB 12
#define ADCCHSELSEQ2_CONV07_MASK 0xF000u
#define REG_ADCCHSELSEQ3 0x7105uL  // channel select slots 8-11
#define ADCCHSELSEQ3_CONV08_LSB 0
#define ADCCHSELSEQ3_CONV08_MASK 0x000Fu
#define ADCCHSELSEQ3_CONV09_LSB 4
#define ADCCHSELSEQ3_CONV09_MASK 0x00F0u
#define ADCCHSELSEQ3_CONV10_LSB 8
#define ADCCHSELSEQ3_CONV10_MASK 0x0F00u
#define ADCCHSELSEQ3_CONV11_LSB 12
#define ADCCHSELSEQ3_CONV11_MASK 0xF000u
#define REG_ADCCHSELSEQ4 0x7106uL  // channel select slots 12-15
#define ADCCHSELSEQ4_CONV12_LSB 0
#define ADCCHSELSEQ4_CONV12_MASK 0x000Fu
#define ADCCHSELSEQ4_CONV13_LSB 4
#define ADCCHSELSEQ4_CONV13_MASK 0x00F0u
#define ADCCHSELSEQ4_CONV14_LSB 8
#define ADCCHSELSEQ4_CONV14_MASK 0x0F00u
#define ADCCHSELSEQ4_CONV15_LSB 12
#define ADCCHSELSEQ4_CONV15_MASK 0xF000u
#define REG_ADCASEQSR 0x7107uL  // autosequence status
#define ADCASEQSR_SEQ1_STATE_LSB 0
#define ADCASEQSR_SEQ1_STATE_MASK 0x000Fu
#define ADCASEQSR_SEQ2_STATE_LSB 4
#define ADCASEQSR_SEQ2_STATE_MASK 0x0070u
#define ADCASEQSR_SEQ_CNTR_LSB 8
#define ADCASEQSR_SEQ_CNTR_MASK 0x0F00u
#define REG_ADCRESULT0 0x7108uL  // result, left justified <<4
#define REG_ADCTRL3 0x7118uL     // power, clock, sampling mode
#define ADCTRL3_SMODE_SEL_LSB 0
#define ADCTRL3_SMODE_SEL_MASK 0x0001u
#define ADCTRL3_ADCCLKPS_LSB 1
#define ADCTRL3_ADCCLKPS_MASK 0x001Eu
#define ADCTRL3_ADCPWDN_LSB 5
#define ADCTRL3_ADCPWDN_MASK 0x0020u
#define ADCTRL3_ADCBGRFDN_LSB 6
#define ADCTRL3_ADCBGRFDN_MASK 0x00C0u
#define REG_ADCST 0x7119uL  // interrupt and busy status
#define ADCST_INT_SEQ1_LSB 0
#define ADCST_INT_SEQ1_MASK 0x0001u
#define ADCST_INT_SEQ2_LSB 1
#define ADCST_INT_SEQ2_MASK 0x0002u
#define ADCST_SEQ1_BSY_LSB 2
#define ADCST_SEQ1_BSY_MASK 0x0004u
#define ADCST_SEQ2_BSY_LSB 3
#define ADCST_SEQ2_BSY_MASK 0x0008u
#define ADCST_INT_SEQ1_CLR_LSB 4
#define ADCST_INT_SEQ1_CLR_MASK 0x0010u
#define ADCST_INT_SEQ2_CLR_LSB 5
#define ADCST_INT_SEQ2_CLR_MASK 0x0020u
#define ADCST_EOS_BUF1_LSB 6
#define ADCST_EOS_BUF1_MASK 0x0040u
#define ADCST_EOS_BUF2_LSB 7
#define ADCST_EOS_BUF2_MASK 0x0080u
#define REG_ADCREFSEL 0x711CuL  // reference source select
#define ADCREFSEL_REF_SEL_LSB 14
#define ADCREFSEL_REF_SEL_MASK 0xC000u
#define REG_ADCOFFTRIM 0x711DuL  // signed offset trim
#define ADCOFFTRIM_OFFSET_TRIM_LSB 0
#define ADCOFFTRIM_OFFSET_TRIM_MASK 0x01FFu
#define REG_MIRROR_ADCRESULT0 0x0B00uL  // result, right justified, 0-wait

// ---- Enhanced PWM 1 to 6 -----------------------------------------------------------------------------
#define EPWM_BASE(n) ((uint32_t)(0x6800uL + 0x40uL * (uint32_t)((n) - 1u)))
#define EPWM_TBCTL 0x00u  // time-base control
#define EPWM_TBCTL_CTRMODE_LSB 0
#define EPWM_TBCTL_CTRMODE_MASK 0x0003u
#define EPWM_TBCTL_PHSEN_LSB 2
#define EPWM_TBCTL_PHSEN_MASK 0x0004u
#define EPWM_TBCTL_PRDLD_LSB 3
#define EPWM_TBCTL_PRDLD_MASK 0x0008u
#define EPWM_TBCTL_SYNCOSEL_LSB 4
#define EPWM_TBCTL_SYNCOSEL_MASK 0x0030u
#define EPWM_TBCTL_SWFSYNC_LSB 6
#define EPWM_TBCTL_SWFSYNC_MASK 0x0040u
#define EPWM_TBCTL_HSPCLKDIV_LSB 7
#define EPWM_TBCTL_HSPCLKDIV_MASK 0x0380u
#define EPWM_TBCTL_CLKDIV_LSB 10
#define EPWM_TBCTL_CLKDIV_MASK 0x1C00u
#define EPWM_TBCTL_PHSDIR_LSB 13
#define EPWM_TBCTL_PHSDIR_MASK 0x2000u
#define EPWM_TBCTL_FREE_SOFT_LSB 14
#define EPWM_TBCTL_FREE_SOFT_MASK 0xC000u
#define EPWM_TBSTS 0x01u  // time-base status
#define EPWM_TBSTS_CTRDIR_LSB 0
#define EPWM_TBSTS_CTRDIR_MASK 0x0001u
#define EPWM_TBSTS_SYNCI_LSB 1
#define EPWM_TBSTS_SYNCI_MASK 0x0002u
#define EPWM_TBSTS_CTRMAX_LSB 2
#define EPWM_TBSTS_CTRMAX_MASK 0x0004u
#define EPWM_TBPHS 0x02u          // phase pair (32 bit) (32)
#define EPWM_TBPHS_TBPHSHR 0x02u  // high-resolution phase
#define EPWM_TBPHS_TBPHS 0x03u    // phase offset
#define EPWM_TBCTR 0x04u          // counter value
#define EPWM_TBPRD 0x05u          // period, shadowed
#define EPWM_CMPCTL 0x07u         // compare shadow control
#define EPWM_CMPCTL_LOADAMODE_LSB 0
#define EPWM_CMPCTL_LOADAMODE_MASK 0x0003u
#define EPWM_CMPCTL_LOADBMODE_LSB 2
#define EPWM_CMPCTL_LOADBMODE_MASK 0x000Cu
#define EPWM_CMPCTL_SHDWAMODE_LSB 4
#define EPWM_CMPCTL_SHDWAMODE_MASK 0x0010u
#define EPWM_CMPCTL_SHDWBMODE_LSB 6
#define EPWM_CMPCTL_SHDWBMODE_MASK 0x0040u
#define EPWM_CMPCTL_SHDWAFULL_LSB 8
#define EPWM_CMPCTL_SHDWAFULL_MASK 0x0100u
#define EPWM_CMPCTL_SHDWBFULL_LSB 9
#define EPWM_CMPCTL_SHDWBFULL_MASK 0x0200u
#define EPWM_CMPA 0x08u         // compare A pair (32 bit) (32)
#define EPWM_CMPA_CMPAHR 0x08u  // high-resolution compare A
#define EPWM_CMPA_CMPA 0x09u    // compare A
#define EPWM_CMPB 0x0Au         // compare B
#define EPWM_AQCTLA 0x0Bu       // output A actions
#define EPWM_AQCTLA_ZRO_LSB 0
#define EPWM_AQCTLA_ZRO_MASK 0x0003u
#define EPWM_AQCTLA_PRD_LSB 2
#define EPWM_AQCTLA_PRD_MASK 0x000Cu
#define EPWM_AQCTLA_CAU_LSB 4
#define EPWM_AQCTLA_CAU_MASK 0x0030u
#define EPWM_AQCTLA_CAD_LSB 6
#define EPWM_AQCTLA_CAD_MASK 0x00C0u
#define EPWM_AQCTLA_CBU_LSB 8
#define EPWM_AQCTLA_CBU_MASK 0x0300u
#define EPWM_AQCTLA_CBD_LSB 10
#define EPWM_AQCTLA_CBD_MASK 0x0C00u
#define EPWM_AQCTLB 0x0Cu  // output B actions
#define EPWM_AQCTLB_ZRO_LSB 0
#define EPWM_AQCTLB_ZRO_MASK 0x0003u
#define EPWM_AQCTLB_PRD_LSB 2
#define EPWM_AQCTLB_PRD_MASK 0x000Cu
#define EPWM_AQCTLB_CAU_LSB 4
#define EPWM_AQCTLB_CAU_MASK 0x0030u
#define EPWM_AQCTLB_CAD_LSB 6
#define EPWM_AQCTLB_CAD_MASK 0x00C0u
#define EPWM_AQCTLB_CBU_LSB 8
#define EPWM_AQCTLB_CBU_MASK 0x0300u
#define EPWM_AQCTLB_CBD_LSB 10
#define EPWM_AQCTLB_CBD_MASK 0x0C00u
#define EPWM_AQSFRC 0x0Du  // one-time software force
#define EPWM_AQSFRC_ACTSFA_LSB 0
#define EPWM_AQSFRC_ACTSFA_MASK 0x0003u
#define EPWM_AQSFRC_OTSFA_LSB 2
#define EPWM_AQSFRC_OTSFA_MASK 0x0004u
#define EPWM_AQSFRC_ACTSFB_LSB 3
#define EPWM_AQSFRC_ACTSFB_MASK 0x0018u
#define EPWM_AQSFRC_OTSFB_LSB 5
#define EPWM_AQSFRC_OTSFB_MASK 0x0020u
#define EPWM_AQSFRC_RLDCSF_LSB 6
#define EPWM_AQSFRC_RLDCSF_MASK 0x00C0u
#define EPWM_AQCSFRC 0x0Eu  // continuous software force
#define EPWM_AQCSFRC_CSFA_LSB 0
#define EPWM_AQCSFRC_CSFA_MASK 0x0003u
#define EPWM_AQCSFRC_CSFB_LSB 2
#define EPWM_AQCSFRC_CSFB_MASK 0x000Cu
#define EPWM_DBCTL 0x0Fu  // dead-band control
#define EPWM_DBCTL_OUT_MODE_LSB 0
#define EPWM_DBCTL_OUT_MODE_MASK 0x0003u
#define EPWM_DBCTL_POLSEL_LSB 2
#define EPWM_DBCTL_POLSEL_MASK 0x000Cu
#define EPWM_DBCTL_IN_MODE_LSB 4
#define EPWM_DBCTL_IN_MODE_MASK 0x0030u
#define EPWM_DBRED 0x10u  // rising delay, 10 bit
#define EPWM_DBRED_DEL_LSB 0
#define EPWM_DBRED_DEL_MASK 0x03FFu
#define EPWM_DBFED 0x11u  // falling delay, 10 bit
#define EPWM_DBFED_DEL_LSB 0
#define EPWM_DBFED_DEL_MASK 0x03FFu
#define EPWM_TZSEL 0x12u  // trip source select (EALLOW)
#define EPWM_TZSEL_CBC1_LSB 0
#define EPWM_TZSEL_CBC1_MASK 0x0001u
#define EPWM_TZSEL_CBC2_LSB 1
#define EPWM_TZSEL_CBC2_MASK 0x0002u
#define EPWM_TZSEL_CBC3_LSB 2
#define EPWM_TZSEL_CBC3_MASK 0x0004u
#define EPWM_TZSEL_CBC4_LSB 3
#define EPWM_TZSEL_CBC4_MASK 0x0008u
#define EPWM_TZSEL_CBC5_LSB 4
#define EPWM_TZSEL_CBC5_MASK 0x0010u
#define EPWM_TZSEL_CBC6_LSB 5
#define EPWM_TZSEL_CBC6_MASK 0x0020u
#define EPWM_TZSEL_OSHT1_LSB 8
#define EPWM_TZSEL_OSHT1_MASK 0x0100u
#define EPWM_TZSEL_OSHT2_LSB 9
#define EPWM_TZSEL_OSHT2_MASK 0x0200u
#define EPWM_TZSEL_OSHT3_LSB 10
#define EPWM_TZSEL_OSHT3_MASK 0x0400u
#define EPWM_TZSEL_OSHT4_LSB 11
#define EPWM_TZSEL_OSHT4_MASK 0x0800u
#define EPWM_TZSEL_OSHT5_LSB 12
#define EPWM_TZSEL_OSHT5_MASK 0x1000u
#define EPWM_TZSEL_OSHT6_LSB 13
#define EPWM_TZSEL_OSHT6_MASK 0x2000u
#define EPWM_TZCTL 0x14u  // trip action (EALLOW)
#define EPWM_TZCTL_TZA_LSB 0
#define EPWM_TZCTL_TZA_MASK 0x0003u
#define EPWM_TZCTL_TZB_LSB 2
#define EPWM_TZCTL_TZB_MASK 0x000Cu
#define EPWM_TZEINT 0x15u  // trip interrupt enable (EALLOW)
#define EPWM_TZEINT_CBC_LSB 1
#define EPWM_TZEINT_CBC_MASK 0x0002u
#define EPWM_TZEINT_OST_LSB 2
#define EPWM_TZEINT_OST_MASK 0x0004u
#define EPWM_TZFLG 0x16u  // trip flags (read)
#define EPWM_TZFLG_INT_LSB 0
#define EPWM_TZFLG_INT_MASK 0x0001u
#define EPWM_TZFLG_CBC_LSB 1
#define EPWM_TZFLG_CBC_MASK 0x0002u
#define EPWM_TZFLG_OST_LSB 2
#define EPWM_TZFLG_OST_MASK 0x0004u
#define EPWM_TZCLR 0x17u  // trip flag clear (EALLOW)
#define EPWM_TZCLR_INT_LSB 0
#define EPWM_TZCLR_INT_MASK 0x0001u
#define EPWM_TZCLR_CBC_LSB 1
#define EPWM_TZCLR_CBC_MASK 0x0002u
#define EPWM_TZCLR_OST_LSB 2
#define EPWM_TZCLR_OST_MASK 0x0004u
#define EPWM_TZFRC 0x18u  // trip software force (EALLOW)
#define EPWM_TZFRC_CBC_LSB 1
#define EPWM_TZFRC_CBC_MASK 0x0002u
#define EPWM_TZFRC_OST_LSB 2
#define EPWM_TZFRC_OST_MASK 0x0004u
#define EPWM_ETSEL 0x19u  // event source select
#define EPWM_ETSEL_INTSEL_LSB 0
#define EPWM_ETSEL_INTSEL_MASK 0x0007u
#define EPWM_ETSEL_INTEN_LSB 3
#define EPWM_ETSEL_INTEN_MASK 0x0008u
#define EPWM_ETSEL_SOCASEL_LSB 8
#define EPWM_ETSEL_SOCASEL_MASK 0x0700u
#define EPWM_ETSEL_SOCAEN_LSB 11
#define EPWM_ETSEL_SOCAEN_MASK 0x0800u
#define EPWM_ETSEL_SOCBSEL_LSB 12
#define EPWM_ETSEL_SOCBSEL_MASK 0x7000u
#define EPWM_ETSEL_SOCBEN_LSB 15
#define EPWM_ETSEL_SOCBEN_MASK 0x8000u
#define EPWM_ETPS 0x1Au  // event prescale
#define EPWM_ETPS_INTPRD_LSB 0
#define EPWM_ETPS_INTPRD_MASK 0x0003u
#define EPWM_ETPS_INTCNT_LSB 2
#define EPWM_ETPS_INTCNT_MASK 0x000Cu
#define EPWM_ETPS_SOCAPRD_LSB 8
#define EPWM_ETPS_SOCAPRD_MASK 0x0300u
#define EPWM_ETPS_SOCACNT_LSB 10
#define EPWM_ETPS_SOCACNT_MASK 0x0C00u
#define EPWM_ETPS_SOCBPRD_LSB 12
#define EPWM_ETPS_SOCBPRD_MASK 0x3000u
#define EPWM_ETPS_SOCBCNT_LSB 14
#define EPWM_ETPS_SOCBCNT_MASK 0xC000u
#define EPWM_ETFLG 0x1Bu  // event flags
#define EPWM_ETFLG_INT_LSB 0
#define EPWM_ETFLG_INT_MASK 0x0001u
#define EPWM_ETFLG_SOCA_LSB 2
#define EPWM_ETFLG_SOCA_MASK 0x0004u
#define EPWM_ETFLG_SOCB_LSB 3
#define EPWM_ETFLG_SOCB_MASK 0x0008u
#define EPWM_ETCLR 0x1Cu  // event flag clear
#define EPWM_ETCLR_INT_LSB 0
#define EPWM_ETCLR_INT_MASK 0x0001u
#define EPWM_ETCLR_SOCA_LSB 2
#define EPWM_ETCLR_SOCA_MASK 0x0004u
#define EPWM_ETCLR_SOCB_LSB 3
#define EPWM_ETCLR_SOCB_MASK 0x0008u
#define EPWM_ETFRC 0x1Du  // event force
#define EPWM_ETFRC_INT_LSB 0
#define EPWM_ETFRC_INT_MASK 0x0001u
#define EPWM_ETFRC_SOCA_LSB 2
#define EPWM_ETFRC_SOCA_MASK 0x0004u
#define EPWM_ETFRC_SOCB_LSB 3
#define EPWM_ETFRC_SOCB_MASK 0x0008u
#define EPWM_PCCTL 0x1Eu  // chopper control
#define EPWM_PCCTL_CHPEN_LSB 0
#define EPWM_PCCTL_CHPEN_MASK 0x0001u
#define EPWM_PCCTL_OSHTWTH_LSB 1
#define EPWM_PCCTL_OSHTWTH_MASK 0x001Eu
#define EPWM_PCCTL_CHPFREQ_LSB 5
#define EPWM_PCCTL_CHPFREQ_MASK 0x00E0u
#define EPWM_PCCTL_CHPDUTY_LSB 8
#define EPWM_PCCTL_CHPDUTY_MASK 0x0700u
#define EPWM_HRCNFG 0x20u  // high-resolution configuration (EALLOW)
#define EPWM_HRCNFG_EDGMODE_LSB 0
#define EPWM_HRCNFG_EDGMODE_MASK 0x0003u
#define EPWM_HRCNFG_CTLMODE_LSB 2
#define EPWM_HRCNFG_CTLMODE_MASK 0x0004u
#define EPWM_HRCNFG_HRLOAD_LSB 3
#define EPWM_HRCNFG_HRLOAD_MASK 0x0008u

// ---- Quadrature encoder 1, 2 -------------------------------------------------------------------------
#define EQEP_BASE(n) ((uint32_t)(0x6B00uL + 0x40uL * (uint32_t)((n) - 1u)))
#define EQEP_QPOSCNT 0x00u   // position counter (32)
#define EQEP_QPOSINIT 0x02u  // init value (32)
#define EQEP_QPOSMAX 0x04u   // maximum position (32)
#define EQEP_QPOSCMP 0x06u   // compare value (32)
#define EQEP_QPOSILAT 0x08u  // index latch (32)
#define EQEP_QPOSSLAT 0x0Au  // strobe latch (32)
#define EQEP_QPOSLAT 0x0Cu   // unit-time latch (32)
#define EQEP_QUTMR 0x0Eu     // unit timer (32)
#define EQEP_QUPRD 0x10u     // unit period (32)
#define EQEP_QWDTMR 0x12u    // watchdog timer
#define EQEP_QWDPRD 0x13u    // watchdog period
#define EQEP_QDECCTL 0x14u   // decoder control
#define EQEP_QDECCTL_QSP_LSB 5
#define EQEP_QDECCTL_QSP_MASK 0x0020u
#define EQEP_QDECCTL_QIP_LSB 6
#define EQEP_QDECCTL_QIP_MASK 0x0040u
#define EQEP_QDECCTL_QBP_LSB 7
#define EQEP_QDECCTL_QBP_MASK 0x0080u
#define EQEP_QDECCTL_QAP_LSB 8
#define EQEP_QDECCTL_QAP_MASK 0x0100u
#define EQEP_QDECCTL_IGATE_LSB 9
#define EQEP_QDECCTL_IGATE_MASK 0x0200u
#define EQEP_QDECCTL_SWAP_LSB 10
#define EQEP_QDECCTL_SWAP_MASK 0x0400u
#define EQEP_QDECCTL_XCR_LSB 11
#define EQEP_QDECCTL_XCR_MASK 0x0800u
#define EQEP_QDECCTL_SPSEL_LSB 12
#define EQEP_QDECCTL_SPSEL_MASK 0x1000u
#define EQEP_QDECCTL_SOEN_LSB 13
#define EQEP_QDECCTL_SOEN_MASK 0x2000u
#define EQEP_QDECCTL_QSRC_LSB 14
#define EQEP_QDECCTL_QSRC_MASK 0xC000u
#define EQEP_QEPCTL 0x15u  // control
#define EQEP_QEPCTL_WDE_LSB 0
#define EQEP_QEPCTL_WDE_MASK 0x0001u
#define EQEP_QEPCTL_UTE_LSB 1
#define EQEP_QEPCTL_UTE_MASK 0x0002u
#define EQEP_QEPCTL_QCLM_LSB 2
#define EQEP_QEPCTL_QCLM_MASK 0x0004u
#define EQEP_QEPCTL_QPEN_LSB 3
#define EQEP_QEPCTL_QPEN_MASK 0x0008u
#define EQEP_QEPCTL_IEL_LSB 4
#define EQEP_QEPCTL_IEL_MASK 0x0030u
#define EQEP_QEPCTL_SEL_LSB 6
#define EQEP_QEPCTL_SEL_MASK 0x0040u
#define EQEP_QEPCTL_SWI_LSB 7
#define EQEP_QEPCTL_SWI_MASK 0x0080u
#define EQEP_QEPCTL_IEI_LSB 8
#define EQEP_QEPCTL_IEI_MASK 0x0300u
#define EQEP_QEPCTL_SEI_LSB 10
#define EQEP_QEPCTL_SEI_MASK 0x0C00u
#define EQEP_QEPCTL_PCRM_LSB 12
#define EQEP_QEPCTL_PCRM_MASK 0x3000u
#define EQEP_QEPCTL_FREE_SOFT_LSB 14
#define EQEP_QEPCTL_FREE_SOFT_MASK 0xC000u
#define EQEP_QCAPCTL 0x16u  // edge capture control
#define EQEP_QCAPCTL_UPPS_LSB 0
#define EQEP_QCAPCTL_UPPS_MASK 0x000Fu
#define EQEP_QCAPCTL_CCPS_LSB 4
#define EQEP_QCAPCTL_CCPS_MASK 0x0070u
#define EQEP_QCAPCTL_CEN_LSB 15
#define EQEP_QCAPCTL_CEN_MASK 0x8000u
#define EQEP_QPOSCTL 0x17u  // position compare control
#define EQEP_QPOSCTL_PCSPW_LSB 0
#define EQEP_QPOSCTL_PCSPW_MASK 0x0FFFu
#define EQEP_QPOSCTL_PCE_LSB 12
#define EQEP_QPOSCTL_PCE_MASK 0x1000u
#define EQEP_QPOSCTL_PCPOL_LSB 13
#define EQEP_QPOSCTL_PCPOL_MASK 0x2000u
#define EQEP_QPOSCTL_PCLOAD_LSB 14
#define EQEP_QPOSCTL_PCLOAD_MASK 0x4000u
#define EQEP_QPOSCTL_PCSHDW_LSB 15
#define EQEP_QPOSCTL_PCSHDW_MASK 0x8000u
#define EQEP_QEINT 0x18u  // interrupt enable
#define EQEP_QEINT_PCE_LSB 1
#define EQEP_QEINT_PCE_MASK 0x0002u
#define EQEP_QEINT_QPE_LSB 2
#define EQEP_QEINT_QPE_MASK 0x0004u
#define EQEP_QEINT_QDC_LSB 3
#define EQEP_QEINT_QDC_MASK 0x0008u
#define EQEP_QEINT_WTO_LSB 4
#define EQEP_QEINT_WTO_MASK 0x0010u
#define EQEP_QEINT_PCU_LSB 5
#define EQEP_QEINT_PCU_MASK 0x0020u
#define EQEP_QEINT_PCO_LSB 6
#define EQEP_QEINT_PCO_MASK 0x0040u
#define EQEP_QEINT_PCR_LSB 7
#define EQEP_QEINT_PCR_MASK 0x0080u
#define EQEP_QEINT_PCM_LSB 8
#define EQEP_QEINT_PCM_MASK 0x0100u
#define EQEP_QEINT_SEL_LSB 9
#define EQEP_QEINT_SEL_MASK 0x0200u
#define EQEP_QEINT_IEL_LSB 10
#define EQEP_QEINT_IEL_MASK 0x0400u
#define EQEP_QEINT_UTO_LSB 11
#define EQEP_QEINT_UTO_MASK 0x0800u
#define EQEP_QFLG 0x19u  // interrupt flags
#define EQEP_QFLG_INT_LSB 0
#define EQEP_QFLG_INT_MASK 0x0001u
#define EQEP_QFLG_PCE_LSB 1
#define EQEP_QFLG_PCE_MASK 0x0002u
#define EQEP_QFLG_PHE_LSB 2
#define EQEP_QFLG_PHE_MASK 0x0004u
#define EQEP_QFLG_QDC_LSB 3
#define EQEP_QFLG_QDC_MASK 0x0008u
#define EQEP_QFLG_WTO_LSB 4
#define EQEP_QFLG_WTO_MASK 0x0010u
#define EQEP_QFLG_PCU_LSB 5
#define EQEP_QFLG_PCU_MASK 0x0020u
#define EQEP_QFLG_PCO_LSB 6
#define EQEP_QFLG_PCO_MASK 0x0040u
#define EQEP_QFLG_PCR_LSB 7
#define EQEP_QFLG_PCR_MASK 0x0080u
#define EQEP_QFLG_PCM_LSB 8
#define EQEP_QFLG_PCM_MASK 0x0100u
#define EQEP_QFLG_SEL_LSB 9
#define EQEP_QFLG_SEL_MASK 0x0200u
#define EQEP_QFLG_IEL_LSB 10
#define EQEP_QFLG_IEL_MASK 0x0400u
#define EQEP_QFLG_UTO_LSB 11
#define EQEP_QFLG_UTO_MASK 0x0800u
#define EQEP_QCLR 0x1Au  // flag clear
#define EQEP_QCLR_INT_LSB 0
#define EQEP_QCLR_INT_MASK 0x0001u
#define EQEP_QCLR_PCE_LSB 1
#define EQEP_QCLR_PCE_MASK 0x0002u
#define EQEP_QCLR_PHE_LSB 2
#define EQEP_QCLR_PHE_MASK 0x0004u
#define EQEP_QCLR_QDC_LSB 3
#define EQEP_QCLR_QDC_MASK 0x0008u
#define EQEP_QCLR_WTO_LSB 4
#define EQEP_QCLR_WTO_MASK 0x0010u
#define EQEP_QCLR_PCU_LSB 5
#define EQEP_QCLR_PCU_MASK 0x0020u
#define EQEP_QCLR_PCO_LSB 6
#define EQEP_QCLR_PCO_MASK 0x0040u
#define EQEP_QCLR_PCR_LSB 7
#define EQEP_QCLR_PCR_MASK 0x0080u
#define EQEP_QCLR_PCM_LSB 8
#define EQEP_QCLR_PCM_MASK 0x0100u
#define EQEP_QCLR_SEL_LSB 9
#define EQEP_QCLR_SEL_MASK 0x0200u
#define EQEP_QCLR_IEL_LSB 10
#define EQEP_QCLR_IEL_MASK 0x0400u
#define EQEP_QCLR_UTO_LSB 11
#define EQEP_QCLR_UTO_MASK 0x0800u
#define EQEP_QFRC 0x1Bu  // flag force
#define EQEP_QFRC_PCE_LSB 1
#define EQEP_QFRC_PCE_MASK 0x0002u
#define EQEP_QFRC_PHE_LSB 2
#define EQEP_QFRC_PHE_MASK 0x0004u
#define EQEP_QFRC_QDC_LSB 3
#define EQEP_QFRC_QDC_MASK 0x0008u
#define EQEP_QFRC_WTO_LSB 4
#define EQEP_QFRC_WTO_MASK 0x0010u
#define EQEP_QFRC_PCU_LSB 5
#define EQEP_QFRC_PCU_MASK 0x0020u
#define EQEP_QFRC_PCO_LSB 6
#define EQEP_QFRC_PCO_MASK 0x0040u
#define EQEP_QFRC_PCR_LSB 7
#define EQEP_QFRC_PCR_MASK 0x0080u
#define EQEP_QFRC_PCM_LSB 8
#define EQEP_QFRC_PCM_MASK 0x0100u
#define EQEP_QFRC_SEL_LSB 9
#define EQEP_QFRC_SEL_MASK 0x0200u
#define EQEP_QFRC_IEL_LSB 10
#define EQEP_QFRC_IEL_MASK 0x0400u
#define EQEP_QFRC_UTO_LSB 11
#define EQEP_QFRC_UTO_MASK 0x0800u
#define EQEP_QEPSTS 0x1Cu  // status
#define EQEP_QEPSTS_PCEF_LSB 0
#define EQEP_QEPSTS_PCEF_MASK 0x0001u
#define EQEP_QEPSTS_FIMF_LSB 1
#define EQEP_QEPSTS_FIMF_MASK 0x0002u
#define EQEP_QEPSTS_CDEF_LSB 2
#define EQEP_QEPSTS_CDEF_MASK 0x0004u
#define EQEP_QEPSTS_COEF_LSB 3
#define EQEP_QEPSTS_COEF_MASK 0x0008u
#define EQEP_QEPSTS_QDLF_LSB 4
#define EQEP_QEPSTS_QDLF_MASK 0x0010u
#define EQEP_QEPSTS_QDF_LSB 5
#define EQEP_QEPSTS_QDF_MASK 0x0020u
#define EQEP_QEPSTS_FIDF_LSB 6
#define EQEP_QEPSTS_FIDF_MASK 0x0040u
#define EQEP_QEPSTS_UPEVNT_LSB 7
#define EQEP_QEPSTS_UPEVNT_MASK 0x0080u
#define EQEP_QCTMR 0x1Du     // capture timer
#define EQEP_QCPRD 0x1Eu     // capture period
#define EQEP_QCTMRLAT 0x1Fu  // capture timer latch
#define EQEP_QCPRDLAT 0x20u  // capture period latch

// ---- Serial port A, B ----------------------------------------------------------------------------------
#define SCI_BASE(n) ((uint32_t)(0x7050uL + 0x700uL * (uint32_t)((n) - 1u)))  // 1 is SCI-A, 2 is SCI-B
#define SCI_CCR 0x00u                                                        // frame format
#define SCI_CCR_SCICHAR_LSB 0
#define SCI_CCR_SCICHAR_MASK 0x0007u
#define SCI_CCR_ADDRIDLE_MODE_LSB 3
#define SCI_CCR_ADDRIDLE_MODE_MASK 0x0008u
#define SCI_CCR_LOOPBKENA_LSB 4
#define SCI_CCR_LOOPBKENA_MASK 0x0010u
#define SCI_CCR_PARITYENA_LSB 5
#define SCI_CCR_PARITYENA_MASK 0x0020u
#define SCI_CCR_PARITY_LSB 6
#define SCI_CCR_PARITY_MASK 0x0040u
#define SCI_CCR_STOPBITS_LSB 7
#define SCI_CCR_STOPBITS_MASK 0x0080u
#define SCI_CTL1 0x01u  // RX/TX enables and reset
#define SCI_CTL1_RXENA_LSB 0
#define SCI_CTL1_RXENA_MASK 0x0001u
#define SCI_CTL1_TXENA_LSB 1
#define SCI_CTL1_TXENA_MASK 0x0002u
#define SCI_CTL1_SLEEP_LSB 2
#define SCI_CTL1_SLEEP_MASK 0x0004u
#define SCI_CTL1_TXWAKE_LSB 3
#define SCI_CTL1_TXWAKE_MASK 0x0008u
#define SCI_CTL1_SWRESET_LSB 5
#define SCI_CTL1_SWRESET_MASK 0x0020u
#define SCI_CTL1_RXERRINTENA_LSB 6
#define SCI_CTL1_RXERRINTENA_MASK 0x0040u
#define SCI_HBAUD 0x02u  // baud divisor high byte
#define SCI_LBAUD 0x03u  // baud divisor low byte
#define SCI_CTL2 0x04u   // TX status, RX/TX interrupt enables
#define SCI_CTL2_TXINTENA_LSB 0
#define SCI_CTL2_TXINTENA_MASK 0x0001u
#define SCI_CTL2_RXBKINTENA_LSB 1
#define SCI_CTL2_RXBKINTENA_MASK 0x0002u
#define SCI_CTL2_TXEMPTY_LSB 6
#define SCI_CTL2_TXEMPTY_MASK 0x0040u
#define SCI_CTL2_TXRDY_LSB 7
#define SCI_CTL2_TXRDY_MASK 0x0080u
#define SCI_RXST 0x05u  // receiver status
#define SCI_RXST_RXWAKE_LSB 1
#define SCI_RXST_RXWAKE_MASK 0x0002u
#define SCI_RXST_PE_LSB 2
#define SCI_RXST_PE_MASK 0x0004u
#define SCI_RXST_OE_LSB 3
#define SCI_RXST_OE_MASK 0x0008u
#define SCI_RXST_FE_LSB 4
#define SCI_RXST_FE_MASK 0x0010u
#define SCI_RXST_BRKDT_LSB 5
#define SCI_RXST_BRKDT_MASK 0x0020u
#define SCI_RXST_RXRDY_LSB 6
#define SCI_RXST_RXRDY_MASK 0x0040u
#define SCI_RXST_RXERROR_LSB 7
#define SCI_RXST_RXERROR_MASK 0x0080u
#define SCI_RXEMU 0x06u  // receive data, emulation read
#define SCI_RXBUF 0x07u  // receive data
#define SCI_RXBUF_RXDT_LSB 0
#define SCI_RXBUF_RXDT_MASK 0x00FFu
#define SCI_RXBUF_SCIFFPE_LSB 14
#define SCI_RXBUF_SCIFFPE_MASK 0x4000u
#define SCI_RXBUF_SCIFFFE_LSB 15
#define SCI_RXBUF_SCIFFFE_MASK 0x8000u
#define SCI_TXBUF 0x09u  // transmit data
#define SCI_FFTX 0x0Au   // transmit FIFO control
#define SCI_FFTX_TXFFIL_LSB 0
#define SCI_FFTX_TXFFIL_MASK 0x001Fu
#define SCI_FFTX_TXFFIENA_LSB 5
#define SCI_FFTX_TXFFIENA_MASK 0x0020u
#define SCI_FFTX_TXFFINTCLR_LSB 6
#define SCI_FFTX_TXFFINTCLR_MASK 0x0040u
#define SCI_FFTX_TXFFINT_LSB 7
#define SCI_FFTX_TXFFINT_MASK 0x0080u
#define SCI_FFTX_TXFFST_LSB 8
#define SCI_FFTX_TXFFST_MASK 0x1F00u
#define SCI_FFTX_TXFIFOXRESET_LSB 13
#define SCI_FFTX_TXFIFOXRESET_MASK 0x2000u
#define SCI_FFTX_SCIFFENA_LSB 14
#define SCI_FFTX_SCIFFENA_MASK 0x4000u
#define SCI_FFTX_SCIRST_LSB 15
#define SCI_FFTX_SCIRST_MASK 0x8000u
#define SCI_FFRX 0x0Bu  // receive FIFO control
#define SCI_FFRX_RXFFIL_LSB 0
#define SCI_FFRX_RXFFIL_MASK 0x001Fu
#define SCI_FFRX_RXFFIENA_LSB 5
#define SCI_FFRX_RXFFIENA_MASK 0x0020u
#define SCI_FFRX_RXFFINTCLR_LSB 6
#define SCI_FFRX_RXFFINTCLR_MASK 0x0040u
#define SCI_FFRX_RXFFINT_LSB 7
#define SCI_FFRX_RXFFINT_MASK 0x0080u
#define SCI_FFRX_RXFFST_LSB 8
#define SCI_FFRX_RXFFST_MASK 0x1F00u
#define SCI_FFRX_RXFIFORESET_LSB 13
#define SCI_FFRX_RXFIFORESET_MASK 0x2000u
#define SCI_FFRX_RXFFOVRCLR_LSB 14
#define SCI_FFRX_RXFFOVRCLR_MASK 0x4000u
#define SCI_FFRX_RXFFOVF_LSB 15
#define SCI_FFRX_RXFFOVF_MASK 0x8000u
#define SCI_FFCT 0x0Cu  // autobaud and FIFO delay
#define SCI_FFCT_FFTXDLY_LSB 0
#define SCI_FFCT_FFTXDLY_MASK 0x00FFu
#define SCI_FFCT_CDC_LSB 13
#define SCI_FFCT_CDC_MASK 0x2000u
#define SCI_FFCT_ABDCLR_LSB 14
#define SCI_FFCT_ABDCLR_MASK 0x4000u
#define SCI_FFCT_ABD_LSB 15
#define SCI_FFCT_ABD_MASK 0x8000u
#define SCI_PRI 0x0Fu  // emulation suspend behaviour
#define SCI_PRI_FREE_LSB 3
#define SCI_PRI_FREE_MASK 0x0008u
#define SCI_PRI_SOFT_LSB 4
#define SCI_PRI_SOFT_MASK 0x0010u

// ---- I2C --------------------------------------------------------------------------------------------------
#define I2C_BASE 0x7900uL  // I2C-A, the only one
#define I2C_OAR 0x00u      // own address
#define I2C_IER 0x01u      // interrupt enables
#define I2C_IER_AL_LSB 0
#define I2C_IER_AL_MASK 0x0001u
#define I2C_IER_NACK_LSB 1
#define I2C_IER_NACK_MASK 0x0002u
#define I2C_IER_ARDY_LSB 2
#define I2C_IER_ARDY_MASK 0x0004u
#define I2C_IER_RRDY_LSB 3
#define I2C_IER_RRDY_MASK 0x0008u
#define I2C_IER_XRDY_LSB 4
#define I2C_IER_XRDY_MASK 0x0010u
#define I2C_IER_SCD_LSB 5
#define I2C_IER_SCD_MASK 0x0020u
#define I2C_IER_AAS_LSB 6
#define I2C_IER_AAS_MASK 0x0040u
#define I2C_STR 0x02u  // status
#define I2C_STR_AL_LSB 0
#define I2C_STR_AL_MASK 0x0001u
#define I2C_STR_NACK_LSB 1
#define I2C_STR_NACK_MASK 0x0002u
#define I2C_STR_ARDY_LSB 2
#define I2C_STR_ARDY_MASK 0x0004u
#define I2C_STR_RRDY_LSB 3
#define I2C_STR_RRDY_MASK 0x0008u
#define I2C_STR_XRDY_LSB 4
#define I2C_STR_XRDY_MASK 0x0010u
#define I2C_STR_SCD_LSB 5
#define I2C_STR_SCD_MASK 0x0020u
#define I2C_STR_AD0_LSB 8
#define I2C_STR_AD0_MASK 0x0100u
#define I2C_STR_AAS_LSB 9
#define I2C_STR_AAS_MASK 0x0200u
#define I2C_STR_XSMT_LSB 10
#define I2C_STR_XSMT_MASK 0x0400u
#define I2C_STR_RSFULL_LSB 11
#define I2C_STR_RSFULL_MASK 0x0800u
#define I2C_STR_BB_LSB 12
#define I2C_STR_BB_MASK 0x1000u
#define I2C_STR_NACKSNT_LSB 13
#define I2C_STR_NACKSNT_MASK 0x2000u
#define I2C_STR_SDIR_LSB 14
#define I2C_STR_SDIR_MASK 0x4000u
#define I2C_CLKL 0x03u  // low-time divider
#define I2C_CLKH 0x04u  // high-time divider
#define I2C_CNT 0x05u   // byte count
#define I2C_DRR 0x06u   // receive data
#define I2C_SAR 0x07u   // slave address
#define I2C_DXR 0x08u   // transmit data
#define I2C_MDR 0x09u   // mode
#define I2C_MDR_BC_LSB 0
#define I2C_MDR_BC_MASK 0x0007u
#define I2C_MDR_FDF_LSB 3
#define I2C_MDR_FDF_MASK 0x0008u
#define I2C_MDR_STB_LSB 4
#define I2C_MDR_STB_MASK 0x0010u
#define I2C_MDR_IRS_LSB 5
#define I2C_MDR_IRS_MASK 0x0020u
#define I2C_MDR_DLB_LSB 6
#define I2C_MDR_DLB_MASK 0x0040u
#define I2C_MDR_RM_LSB 7
#define I2C_MDR_RM_MASK 0x0080u
#define I2C_MDR_XA_LSB 8
#define I2C_MDR_XA_MASK 0x0100u
#define I2C_MDR_TRX_LSB 9
#define I2C_MDR_TRX_MASK 0x0200u
#define I2C_MDR_MST_LSB 10
#define I2C_MDR_MST_MASK 0x0400u
#define I2C_MDR_STP_LSB 11
#define I2C_MDR_STP_MASK 0x0800u
#define I2C_MDR_STT_LSB 13
#define I2C_MDR_STT_MASK 0x2000u
#define I2C_MDR_FREE_LSB 14
#define I2C_MDR_FREE_MASK 0x4000u
#define I2C_MDR_NACKMOD_LSB 15
#define I2C_MDR_NACKMOD_MASK 0x8000u
#define I2C_ISRC 0x0Au  // interrupt source code
#define I2C_ISRC_INTCODE_LSB 0
#define I2C_ISRC_INTCODE_MASK 0x0007u
#define I2C_PSC 0x0Cu  // module clock prescale
#define I2C_PSC_IPSC_LSB 0
#define I2C_PSC_IPSC_MASK 0x00FFu
#define I2C_FFTX 0x20u  // transmit FIFO
#define I2C_FFTX_TXFFIL_LSB 0
#define I2C_FFTX_TXFFIL_MASK 0x001Fu
#define I2C_FFTX_TXFFIENA_LSB 5
#define I2C_FFTX_TXFFIENA_MASK 0x0020u
#define I2C_FFTX_TXFFINTCLR_LSB 6
#define I2C_FFTX_TXFFINTCLR_MASK 0x0040u
#define I2C_FFTX_TXFFINT_LSB 7
#define I2C_FFTX_TXFFINT_MASK 0x0080u
#define I2C_FFTX_TXFFST_LSB 8
#define I2C_FFTX_TXFFST_MASK 0x1F00u
#define I2C_FFTX_TXFFRST_LSB 13
#define I2C_FFTX_TXFFRST_MASK 0x2000u
#define I2C_FFTX_I2CFFEN_LSB 14
#define I2C_FFTX_I2CFFEN_MASK 0x4000u
#define I2C_FFRX 0x21u  // receive FIFO
#define I2C_FFRX_RXFFIL_LSB 0
#define I2C_FFRX_RXFFIL_MASK 0x001Fu
#define I2C_FFRX_RXFFIENA_LSB 5
#define I2C_FFRX_RXFFIENA_MASK 0x0020u
#define I2C_FFRX_RXFFINTCLR_LSB 6
#define I2C_FFRX_RXFFINTCLR_MASK 0x0040u
#define I2C_FFRX_RXFFINT_LSB 7
#define I2C_FFRX_RXFFINT_MASK 0x0080u
#define I2C_FFRX_RXFFST_LSB 8
#define I2C_FFRX_RXFFST_MASK 0x1F00u
#define I2C_FFRX_RXFFRST_LSB 13
#define I2C_FFRX_RXFFRST_MASK 0x2000u

// ---- Controller area network A -----------------------------------------------------------------------
#include "hal/f2808/registers_can.h"

// ---- External interrupts -----------------------------------------------------------------------------
#define REG_XINT1CR 0x7070uL  // XINT1 control
#define XINT1CR_ENABLE_LSB 0
#define XINT1CR_ENABLE_MASK 0x0001u
#define XINT1CR_POLARITY_LSB 2
#define XINT1CR_POLARITY_MASK 0x000Cu
#define REG_XINT2CR 0x7071uL  // XINT2 control
#define XINT2CR_ENABLE_LSB 0
#define XINT2CR_ENABLE_MASK 0x0001u
#define XINT2CR_POLARITY_LSB 2
#define XINT2CR_POLARITY_MASK 0x000Cu
#define REG_XNMICR 0x7077uL  // XNMI control
#define XNMICR_ENABLE_LSB 0
#define XNMICR_ENABLE_MASK 0x0001u
#define XNMICR_SELECT_LSB 1
#define XNMICR_SELECT_MASK 0x0002u
#define XNMICR_POLARITY_LSB 2
#define XNMICR_POLARITY_MASK 0x000Cu
#define REG_XINT1CTR 0x7078uL  // XINT1 edge time counter
#define REG_XINT2CTR 0x7079uL  // XINT2 edge time counter
#define REG_XNMICTR 0x707FuL   // XNMI edge time counter

// ---- Interrupt vectors (index into the PIE table of 128) ---------------------------------------------
#define VECTOR_TINT2 14u
#define VECTOR_DATALOG 15u
#define VECTOR_RTOSINT 16u
#define VECTOR_EMUINT 17u
#define VECTOR_XNMI 18u
#define VECTOR_ILLEGAL 19u
#define VECTOR_SEQ1INT 32u      // INT1.1: ADC sequencer 1 done
#define VECTOR_SEQ2INT 33u      // INT1.2: ADC sequencer 2 done
#define VECTOR_XINT1 35u        // INT1.4: external 1
#define VECTOR_XINT2 36u        // INT1.5: external 2
#define VECTOR_ADCINT 37u       // INT1.6: ADC SEQ1 or SEQ2 combined
#define VECTOR_TINT0 38u        // INT1.7: CPU timer 0
#define VECTOR_WAKEINT 39u      // INT1.8: watchdog or low-power wake
#define VECTOR_EPWM1_TZINT 40u  // INT2.1: ePWM1 trip zone
#define VECTOR_EPWM2_TZINT 41u  // INT2.2: ePWM2 trip zone
#define VECTOR_EPWM3_TZINT 42u  // INT2.3: ePWM3 trip zone
#define VECTOR_EPWM4_TZINT 43u  // INT2.4: ePWM4 trip zone
#define VECTOR_EPWM5_TZINT 44u  // INT2.5: ePWM5 trip zone
#define VECTOR_EPWM6_TZINT 45u  // INT2.6: ePWM6 trip zone
#define VECTOR_EPWM1_INT 48u    // INT3.1: ePWM1 event
#define VECTOR_EPWM2_INT 49u    // INT3.2: ePWM2 event
#define VECTOR_EPWM3_INT 50u    // INT3.3: ePWM3 event
#define VECTOR_EPWM4_INT 51u    // INT3.4: ePWM4 event
#define VECTOR_EPWM5_INT 52u    // INT3.5: ePWM5 event
#define VECTOR_EPWM6_INT 53u    // INT3.6: ePWM6 event
#define VECTOR_ECAP1_INT 56u    // INT4.1: capture event
#define VECTOR_ECAP2_INT 57u    // INT4.2: capture event
#define VECTOR_ECAP3_INT 58u    // INT4.3: capture event
#define VECTOR_ECAP4_INT 59u    // INT4.4: capture event
#define VECTOR_EQEP1_INT 64u    // INT5.1: encoder event
#define VECTOR_EQEP2_INT 65u    // INT5.2: encoder event
#define VECTOR_SPIRXINTA 72u    // INT6.1: SPI receive
#define VECTOR_SPITXINTA 73u    // INT6.2: SPI transmit
#define VECTOR_SPIRXINTB 74u    // INT6.3: SPI receive
#define VECTOR_SPITXINTB 75u    // INT6.4: SPI transmit
#define VECTOR_SPIRXINTC 76u    // INT6.5: SPI receive
#define VECTOR_SPITXINTC 77u    // INT6.6: SPI transmit
#define VECTOR_SPIRXINTD 78u    // INT6.7: SPI receive
#define VECTOR_SPITXINTD 79u    // INT6.8: SPI transmit
#define VECTOR_I2CINT1A 88u     // INT8.1: I2C basic
#define VECTOR_I2CINT2A 89u     // INT8.2: I2C FIFO
#define VECTOR_SCIRXINTA 96u    // INT9.1: SCI receive
#define VECTOR_SCITXINTA 97u    // INT9.2: SCI transmit
#define VECTOR_SCIRXINTB 98u    // INT9.3: SCI receive
#define VECTOR_SCITXINTB 99u    // INT9.4: SCI transmit
#define VECTOR_ECAN0INTA 100u   // INT9.5: eCAN line 0
#define VECTOR_ECAN1INTA 101u   // INT9.6: eCAN line 1
#define VECTOR_ECAN0INTB 102u   // INT9.7: eCAN line 0
#define VECTOR_ECAN1INTB 103u   // INT9.8: eCAN line 1
#define VECTOR_COUNT 128u
#define VECTOR_PIE_FIRST 32u  // INT1.1; a group has eight channels

#endif
